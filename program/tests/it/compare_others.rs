//! `compare` with another model and another run beside the first.

use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

const SAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../bags/samples/hidden-law");

fn bag(name: &str) -> String {
    Path::new(SAMPLES).join(name).display().to_string()
}

fn compared(folder: &Path, more: &[&str]) -> (Value, String) {
    let json = folder.join("result.json");
    let words = ["compare", "--bag", &bag("validation"), "--force", "--json", json.to_str().unwrap()];
    let output = Command::cargo_bin("excavator").unwrap().args(words).args(more).assert().success();
    let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    (serde_json::from_str(&std::fs::read_to_string(json).unwrap()).unwrap(), text)
}

/// The paper's arm with twice its inertia.
fn heavier(folder: &Path) -> String {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../config/zx30u-arm.toml")).unwrap();
    let path = folder.join("heavier.toml");
    std::fs::write(&path, text.replace("value = 13000.0", "value = 26000.0")).unwrap();
    path.display().to_string()
}

#[test]
fn another_model_has_the_error_that_it_has_alone() {
    let folder = tempfile::tempdir().unwrap();
    let other = heavier(folder.path());
    let (alone, _) = compared(folder.path(), &["--model", &other]);
    let page = folder.path().join("page.html").display().to_string();
    let (both, text) = compared(folder.path(), &["--model", "zx30u-arm", "--against", &other, "--report", &page]);
    assert_ne!(alone["mean_nmse"], both["mean_nmse"]);
    assert_eq!(alone["mean_nmse"], both["against"]["mean_nmse"]);
    assert!(text.contains("The other model is") && text.contains("other model"), "{text}");
    assert!(both["repeat"].is_null());
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains(r#""label":"other model""#), "the page has no line of the other model");
}

#[test]
fn a_run_repeats_itself_and_not_another_one() {
    let folder = tempfile::tempdir().unwrap();
    let (same, text) = compared(folder.path(), &["--model", "zx30u-arm", "--repeat", &bag("validation")]);
    assert!(same["repeat"]["mean_nmse"].as_f64().unwrap() < 1e-9, "{}", same["repeat"]);
    assert!(text.contains("a perfect model could come that close"), "{text}");
    let (_, text) = compared(folder.path(), &["--model", "zx30u-arm", "--repeat", &bag("identification")]);
    assert!(text.contains("does not measure repeatability"), "{text}");
}
