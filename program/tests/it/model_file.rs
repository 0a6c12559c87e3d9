//! The model file: its reference page and schema are those of the code, and a check finds what is odd.

use std::path::Path;

use assert_cmd::Command;
use boon::{Compiler, Schemas};
use serde_json::Value;

const REPOSITORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn printed(arguments: &[&str]) -> String {
    let output =
        Command::cargo_bin("excavator").unwrap().args(arguments).assert().success().get_output().stdout.clone();
    String::from_utf8(output).unwrap()
}

fn stored(path: &str) -> String {
    std::fs::read_to_string(Path::new(REPOSITORY).join(path)).unwrap()
}

#[test]
fn generated_pages_are_those_of_the_program() {
    for (words, path) in [
        (["model", "reference"], "docs/model-file.md"),
        (["model", "schema"], "config/model.schema.json"),
        (["manual", "verbs"], "docs/verbs.md"),
        (["manual", "parameters"], "docs/parameters.md"),
        (["manual", "results"], "docs/results.md"),
    ] {
        assert!(printed(&words) == stored(path), "write {path} anew: excavator {} > {path}", words.join(" "));
    }
}

#[test]
fn the_faulty_line_of_a_file_stands_under_the_message() {
    let folder = tempfile::tempdir().unwrap();
    let faulty = folder.path().join("faulty.toml");
    std::fs::write(&faulty, "format = 2\narea = 38 mm2 \u{1b}[2J\n").unwrap();
    let path = faulty.to_str().unwrap();
    let bag = format!("{REPOSITORY}/bags/samples/hidden-law/validation");
    let simulate = ["simulate", "--model", "zx30u-arm", "--input", path, "-o", "out"];
    for words in [
        &["model", "check", path][..],
        &["compare", "--model", "zx30u-arm", "--bag", &bag, "--map", path],
        &["effects", "--catalogue", path],
        &simulate,
    ] {
        let failed = Command::cargo_bin("excavator").unwrap().args(words).assert().failure();
        let said = String::from_utf8(failed.get_output().stderr.clone()).unwrap();
        let lines: Vec<&str> = said.lines().collect();
        assert!(lines[0].contains("line 2, column") && !lines[0].contains("area ="), "{words:?}: {said}");
        assert_eq!(lines.len(), 4, "{words:?}: {said}");
        assert!(lines[2].starts_with("2 | area = 38 mm2") && lines[3].ends_with('^'), "{words:?}: {said}");
        assert!(!said.contains('\u{1b}'), "{words:?}: {said}");
    }
}

/// Every model file of the repository and, where they are, of other people.
fn model_files() -> Vec<std::path::PathBuf> {
    let folder = Path::new(REPOSITORY).join("config");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    match std::fs::read_dir(Path::new(REPOSITORY).join("../shared/practice-sizes")) {
        Ok(cases) => files.extend(cases.map(|case| case.unwrap().path().join("model.toml"))),
        Err(_) => eprintln!("skipped: ../shared/practice-sizes is absent"),
    }
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml") && file.exists());
    files
}

#[test]
fn schema_accepts_what_is_read_and_refuses_what_is_not() {
    let schema: Value = serde_json::from_str(&stored("config/model.schema.json")).unwrap();
    let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
    compiler.add_resource("model.schema.json", schema).unwrap();
    let schema = compiler.compile("model.schema.json", &mut schemas).unwrap();
    let is_valid = |text: &str| schemas.validate(&toml::from_str::<Value>(text).unwrap(), schema).is_ok();
    let files = model_files();
    assert!(files.len() >= 5);
    for file in &files {
        assert!(is_valid(&std::fs::read_to_string(file).unwrap()), "{}", file.display());
    }
    let model = stored("config/servo-bench.toml");
    for (right, wrong) in [
        ("value = 0.5, unit = \"m\"", "value = 500.0, unit = \"mm\""),
        ("value = 0.5, unit = \"m\"", "value = -0.5, unit = \"m\""),
        ("mass = {", "weight = {"),
        ("kind = \"pressure_source\"", "kind = \"pressure_sauce\""),
        ("[machine.supply]", "[machine.suply]"),
        ("value = 300.0, unit = \"kg\"", "value = 300.0, unit = \"N\""),
    ] {
        assert!(model.contains(right), "{right}");
        let changed = model.replacen(right, wrong, 1);
        assert!(!is_valid(&changed), "{wrong}");
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("wrong.toml");
        std::fs::write(&file, changed).unwrap();
        Command::cargo_bin("excavator").unwrap().args(["model", "check"]).arg(&file).assert().failure();
    }
}

#[test]
fn check_finds_nothing_odd_in_the_models_of_the_repository() {
    for file in model_files() {
        let output = printed(&["model", "check", file.to_str().unwrap()]);
        assert!(output.contains("No number is suspicious"), "{}\n{output}", file.display());
    }
}

#[test]
fn check_tells_what_is_odd() {
    let model = stored("config/servo-bench.toml");
    let dead_zone = "\n[[effects]]\neffect = \"valve_dead_zone\"\nat = \"load\"\n[effects.parameters]\n\
        dead_zone_positive = { value = 2e-4, unit = \"m2\" }\ndead_zone_negative = { value = 1e-6, unit = \"m2\" }\n";
    for (right, wrong, told) in [
        ("value = 1.0e9, unit = \"Pa\"", "value = 1e5, unit = \"Pa\"", "load.bulk_modulus = 1e5 Pa: a plausible value"),
        ("cap_area = { value = 0.003117", "cap_area = { value = 0.001117", "are the two sides swapped?"),
        ("cap_dead_volume = { value = 2e-04", "cap_dead_volume = { value = 0.2", "times what the piston sweeps"),
        (
            "maximum_orifice_area = { value = 1e-4",
            "maximum_orifice_area = { value = 1e-1",
            "is larger than the piston's",
        ),
        ("", dead_zone, "load.dead_zone_positive = 2e-4 m2: a plausible value lies between 0 and 1e-4"),
    ] {
        let changed = if right.is_empty() { format!("{model}{wrong}") } else { model.replacen(right, wrong, 1) };
        assert_ne!(changed, model, "{right}");
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("odd.toml");
        std::fs::write(&file, changed).unwrap();
        let assert = Command::cargo_bin("excavator").unwrap().args(["model", "check"]).arg(&file).assert().code(1);
        let output = String::from_utf8_lossy(&assert.get_output().stdout).to_string();
        assert!(output.contains(told), "{told}\n{output}");
    }
}
