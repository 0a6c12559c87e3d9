//! The built site: every page is there, and every link of it leads to a file and a heading of it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use excavator_book::{build, docs};
use regex::Regex;

/// Links and pictures of a page.
fn targets(html: &str) -> Vec<String> {
    let pattern = Regex::new(r#"\s(?:href|src)="([^"]*)""#).unwrap();
    pattern.captures_iter(html).map(|found| found[1].replace("&amp;", "&")).collect()
}

fn anchors(html: &str) -> HashSet<String> {
    let pattern = Regex::new(r#"\sid="([^"]*)""#).unwrap();
    pattern.captures_iter(html).map(|found| found[1].to_string()).collect()
}

fn fault(page: &Path, html: &str, target: &str) -> Option<String> {
    if target.is_empty() || Regex::new("^(?:[a-z]+:|//)").unwrap().is_match(target) {
        return None;
    }
    let (name, anchor) = target.split_once('#').unwrap_or((target, ""));
    let goal = if name.is_empty() { page.to_path_buf() } else { page.parent().unwrap().join(name) };
    if !goal.is_file() {
        return Some(format!("{}: {target} does not exist", page.display()));
    }
    let text = if name.is_empty() { html.to_string() } else { fs::read_to_string(&goal).unwrap_or_default() };
    let known =
        anchor.is_empty() || goal.extension().is_none_or(|kind| kind != "html") || anchors(&text).contains(anchor);
    (!known).then(|| format!("{}: {target}: no such heading", page.display()))
}

#[test]
fn the_site_has_every_page_and_no_dead_link() {
    let site = tempfile::tempdir().unwrap();
    let pages = build(&docs(), site.path()).unwrap();
    assert!(pages.len() > 20, "only {} pages", pages.len());
    let mut faults = Vec::new();
    let mut links = 0;
    for page in &pages {
        let file: PathBuf = site.path().join(page).with_extension("html");
        let html = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert!(html.contains("<main>"), "{} has no text", file.display());
        let found = targets(&html);
        links += found.len();
        faults.extend(found.iter().filter_map(|target| fault(&file, &html, target)));
    }
    assert!(links > 500, "only {links} links were checked");
    assert_eq!(faults, Vec::<String>::new());
}

#[test]
fn a_dead_link_and_a_missing_heading_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html");
    let html = r#"<main><h2 id="here">Here</h2></main>"#;
    fs::write(&page, html).unwrap();
    assert_eq!(fault(&page, html, "#here"), None);
    assert_eq!(fault(&page, html, "https://example.org/x"), None);
    assert!(fault(&page, html, "#there").unwrap().ends_with("no such heading"));
    assert!(fault(&page, html, "other.html").unwrap().ends_with("does not exist"));
}
