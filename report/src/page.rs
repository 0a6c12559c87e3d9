//! The frame of a page: head, title, table of contents, and everything inline.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::assets::{DARK_STYLE, PAGE_SCRIPTS, PAGE_STYLE, SCHEME_SCRIPT, UPLOT_LICENCE, UPLOT_STYLE, uplot_script};

/// A page may load nothing except its embedded content.
const CONTENT_POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// Media query for the dark scheme until the page's button overrides it. It never applies to paper.
const DARK_MEDIA: &str = "screen and (prefers-color-scheme: dark)";

/// One part of a page.
pub(super) struct Section {
    /// Anchor.
    pub anchor: &'static str,
    /// Heading.
    pub title: String,
    /// Content below the heading.
    pub body: Markup,
}

/// A whole page.
pub(super) fn page(kind: &str, title: &str, lead: &Markup, sections: &[Section]) -> String {
    let licence = format!("/*\nuPlot 1.6.32\n{}*/", UPLOT_LICENCE.replace("*/", ""));
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(CONTENT_POLICY);
                meta name="generator" content=(concat!("excavator ", env!("CARGO_PKG_VERSION")));
                title { (kind) " · " (title) }
                style { (PreEscaped(UPLOT_STYLE)) (PreEscaped(PAGE_STYLE)) }
                style.dark media=(DARK_MEDIA) { (PreEscaped(DARK_STYLE)) }
                script { (PreEscaped(SCHEME_SCRIPT)) }
            }
            body {
                main {
                    header {
                        button.scheme type="button" hidden { "Colours" }
                        p.kind { (kind) }
                        h1 { (title) }
                        (lead)
                    }
                    @if sections.len() > 1 {
                        nav aria-label="Contents" {
                            @for section in sections { a href={ "#" (section.anchor) } { (section.title) } }
                        }
                    }
                    @for section in sections {
                        section id=(section.anchor) {
                            h2 { (section.title) }
                            (section.body)
                        }
                    }
                    footer { "Written by excavator " (env!("CARGO_PKG_VERSION")) ". Everything is in this file; it needs no network." }
                }
                script { (PreEscaped(licence)) (PreEscaped(uplot_script())) }
                @for part in PAGE_SCRIPTS { script { (PreEscaped(part)) } }
            }
        }
    }
    .into_string()
}

/// A large number with its meaning under it.
pub(super) fn tile(value: &str, meaning: &str) -> Markup {
    html! { div.tile { div.value { (value) } div.meaning { (meaning) } } }
}
