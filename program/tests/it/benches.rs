//! From a stranger's table and data sheet to a verdict, in one command: ten test benches by an independent simulator.

use std::path::{Path, PathBuf};

use crate::common::{complaint, excavator, json};
use serde_json::Value;

fn benches() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/blind/bench/cases")
}

fn read(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Tables of a case whose names begin so, in order.
fn tables(case: &Path, start: &str) -> Vec<String> {
    let mut found: Vec<String> = std::fs::read_dir(case)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "csv"))
        .filter(|path| path.file_name().unwrap().to_str().unwrap().starts_with(start))
        .map(|path| path.to_str().unwrap().to_string())
        .collect();
    found.sort();
    found
}

/// The diagnosis of a case with the model that its data sheet makes.
fn diagnosed(name: &str) -> (Value, Value) {
    let case = benches().join(name);
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("bench.toml");
    let options = std::fs::read_to_string(case.join("model-new.args")).unwrap();
    let mut words = vec!["model", "new"];
    words.extend(options.lines());
    words.extend(["-o", model.to_str().unwrap()]);
    let made = excavator(folder.path(), &words);
    assert!(made.status.success(), "{}", complaint(&made));

    let map = case.join("map.toml");
    let (identification, validation) = (tables(&case, "identification"), tables(&case, "validation"));
    let mut words = vec!["diagnose", "--json", "-", "--model", model.to_str().unwrap(), "--map", map.to_str().unwrap()];
    words.push("--identification");
    words.extend(identification.iter().map(String::as_str));
    words.push("--validation");
    words.extend(validation.iter().map(String::as_str));
    let mut answer = read(&case.join("answer.json"));
    // Our coefficient is the whole difference between both directions.
    if let Some(half) = answer["coefficients"]["half_difference"]["value"].as_f64() {
        answer["coefficients"]["whole_difference"] = serde_json::json!({ "value": 2.0 * half });
    }
    (json(&excavator(folder.path(), &words)), answer)
}

fn coefficient<'v>(candidate: &'v Value, list: &str, name: &str) -> &'v Value {
    let all = candidate[list].as_array().unwrap();
    all.iter().find(|one| one["name"] == name).unwrap_or_else(|| panic!("no {name} in {candidate:#}"))
}

fn assert_near(name: &str, found: &Value, wanted: f64) {
    let value = found["value"].as_f64().unwrap();
    assert!((value / wanted - 1.0).abs() < 0.1, "{name}: {value}, truly {wanted}");
}

/// The effect is named, alone, with its coefficients and the mass within a tenth of the truth.
fn is_found(case: &str, coefficients: &[(&str, &[&str])]) {
    let (diagnosis, answer) = diagnosed(case);
    assert_eq!(diagnosis["verdict"], "missing_effect", "{case}: {diagnosis:#}");
    let first = &diagnosis["candidates"][0];
    assert_eq!((&first["effect"], &first["tied_with_first"]), (&answer["hidden"], &Value::Bool(false)), "{case}");
    for (name, path) in coefficients {
        let truth = path.iter().fold(&answer["coefficients"], |value, key| &value[*key])["value"].as_f64();
        assert_near(name, coefficient(first, "parameters", name), truth.unwrap());
    }
    let load = ["mass", "inertia"].into_iter().find_map(|name| Some((name, answer["base"][name]["value"].as_f64()?)));
    let (name, truth) = load.unwrap();
    let found = coefficient(first, "refitted", &format!("load.{name}"));
    // Where friction takes nearly all of the force, a recording says little of the mass, and says so.
    let margin = found["margin_95"].as_f64().unwrap();
    if margin < 0.1 * truth {
        assert_near(name, found, truth);
    }
}

fn is_adequate(case: &str) {
    let (diagnosis, answer) = diagnosed(case);
    assert_eq!(answer["hidden"], "nothing");
    assert_eq!(diagnosis["verdict"], "adequate", "{case}: {diagnosis:#}");
}

#[test]
fn a_closed_circuit_with_nothing_hidden_is_adequate() {
    is_adequate("05");
}

#[test]
fn a_winch_with_nothing_hidden_is_adequate() {
    is_adequate("08");
}

/// A small valve with coarse converters, strokes onto stops that are not where the data sheet says, pieces of one second.
#[test]
#[ignore = "two minutes; tests/run --long"]
fn effects_are_found_at_small_benches() {
    is_found("01", &[("load.dead_zone_positive", &["positive"]), ("load.dead_zone_negative", &["negative"])]);
    is_found("02", &[("load.extension_friction_change", &["whole_difference"])]);
    is_found("04", &[("load.lag_time", &["time_constant"])]);
}

/// A closed circuit of unequal areas, a load-sensing pump with another regulator than ours, a law of no catalogue: the right name, or none.
#[test]
#[ignore = "two minutes; tests/run --long"]
fn nothing_wrong_is_said_of_machines_that_the_model_does_not_quite_fit() {
    for case in ["06", "09", "10"] {
        let (diagnosis, answer) = diagnosed(case);
        let is_named =
            diagnosis["verdict"] == "missing_effect" && diagnosis["candidates"][0]["effect"] == answer["hidden"];
        assert!(is_named || diagnosis["verdict"] == "unexplained", "{case}: {diagnosis:#}");
    }
    let (_, law) = diagnosed("10");
    assert_eq!(law["hidden"], "outside");
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn a_dead_zone_is_found_at_a_motor() {
        is_found("07", &[("load.dead_zone_positive", &["positive"]), ("load.dead_zone_negative", &["negative"])]);
    }

    /// Cells are missing, and the command for up to 0.14 s.
    #[test]
    fn friction_of_seals_is_found_in_a_table_with_holes() {
        is_found("03", &[("load.pressure_friction", &["per_pressure_sum"])]);
    }
}
