//! Proposed laws as a user meets them, on recordings with laws that no catalogue has.

use std::path::{Path, PathBuf};

use crate::common::{excavator, json, shared};
use serde_json::Value;

fn sample() -> PathBuf {
    std::fs::canonicalize(Path::new(env!("CARGO_MANIFEST_DIR")).join("../bags/samples/hidden-law")).unwrap()
}

/// As much of the sample as tells the law.
const PARTS: [&str; 2] = ["identification@..8", "validation@..5"];

/// Asks for laws in a folder of its own. `recordings`: names in `data`, to fit and to judge.
fn proposed(folder: &Path, data: &Path, recordings: [&str; 2], more: &[&str]) -> Value {
    let [identification, validation] = recordings.map(|part| data.join(part).display().to_string());
    let words = ["propose", "--model", "zx30u-arm", "--json", "-", "--identification", &identification];
    let words: Vec<&str> = words.into_iter().chain(["--validation", &validation]).chain(more.iter().copied()).collect();
    json(&excavator(folder, &words))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn a_law_that_no_catalogue_has_is_proposed_and_added() {
    let (folder, data) = (tempfile::tempdir().unwrap(), sample());
    let found = proposed(folder.path(), &data, PARTS, &["-o", "laws.toml", "--report", "laws.html"]);
    assert_eq!(found["verdict"], "law");
    let first = &found["proposals"][0];
    assert_eq!((&first["acts_on"], &first["formula"]), (&"piston_force".into(), &"-k*v*abs(p_cap - p_rod)".into()));
    assert_eq!(first["dissipates"], true);
    let (before, after) = (number(&first["validation_error_before"]), number(&first["validation_error_after"]));
    assert!(after < 0.05 * before, "{before} {after}");
    // Others that are fitted leave more.
    let others = found["proposals"].as_array().unwrap().iter().skip(1);
    assert!(others.clone().count() > 0);
    others.for_each(|other| assert_eq!(other["tied_with_first"], false, "{other}"));
    let page = std::fs::read_to_string(folder.path().join("laws.html")).unwrap();
    for part in ["What the equations lack", "Error against complexity", "-k*v*abs(p_cap - p_rod)"] {
        assert!(page.contains(part), "{part}");
    }

    // What was written can be added, and the error falls to what was promised.
    let name = format!("{}@arm", first["name"].as_str().unwrap());
    let [identification, validation] = PARTS.map(|part| data.join(part).display().to_string());
    let words =
        ["refine", "--model", "zx30u-arm", "--catalogue", "laws.toml", "--add", &name, "--json", "-", "-o", "own.toml"];
    let words: Vec<&str> =
        words.into_iter().chain(["--identification", &identification, "--validation", &validation]).collect();
    let refined = json(&excavator(folder.path(), &words));
    let last = refined["steps"].as_array().unwrap().last().unwrap();
    let signals: Vec<f64> = last["signals"].as_object().unwrap().values().map(|one| number(&one["nmse"])).collect();
    let mean = signals.iter().sum::<f64>() / signals.len() as f64;
    assert!((mean / after - 1.0).abs() < 0.02, "{mean} {after}");
    let enters = &found["enters"][0];
    assert_eq!((&enters["name"], &enters["share"]), (&"piston_force@arm".into(), &1.0.into()));
    assert_eq!(found["depends_on"][0]["name"], "v");
    assert!(std::fs::read_to_string(folder.path().join("own.toml")).unwrap().contains("-k*v*abs(p_cap - p_rod)"));
}

/// The form of the true law first, its coefficient within 10 %, and nothing tied with it that has as few parameters.
fn is_found(case: &str, formula: &str) {
    let Some(practice) = shared().map(|shared| shared.join("practice-laws")).filter(|folder| folder.exists()) else {
        println!("skipped: no practice recordings of laws");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let found = proposed(
        folder.path(),
        &std::fs::canonicalize(practice.join(case)).unwrap(),
        ["identification", "validation"],
        &[],
    );
    let answers: Value =
        serde_json::from_str(&std::fs::read_to_string(practice.join("answers.json")).unwrap()).unwrap();
    assert_eq!(found["verdict"], "law", "{case}");
    let first = &found["proposals"][0];
    assert_eq!(first["formula"], formula, "{case}");
    let (value, truth) = (number(&first["parameters"][0]["value"]), number(&answers[case]["k"]));
    assert!((value / truth - 1.0).abs() < 0.1, "{case}: {value}, true {truth}");
}

#[test]
#[ignore = "one minute; tests/run --long"]
fn friction_that_grows_with_the_distance_from_mid_stroke_is_found() {
    is_found("q00", "-k*sign(v)*abs(s)");
}

#[test]
#[ignore = "one minute; tests/run --long"]
fn damping_that_grows_with_the_load_is_found() {
    is_found("q01", "-k*v*abs(p_cap - p_rod)");
}

#[test]
#[ignore = "one minute; tests/run --long"]
fn a_turbulent_leak_past_the_piston_is_found() {
    is_found("q02", "k*(p_cap - p_rod)*abs(p_cap - p_rod)");
}

#[test]
#[ignore = "one minute; tests/run --long"]
fn an_opening_that_pressure_closes_is_found() {
    is_found("q03", "u - k*u*p_pump");
}
