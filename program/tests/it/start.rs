//! From the tables of benches and their data sheets, in one command or step by step.

use std::path::{Path, PathBuf};

use crate::common::{complaint, excavator, json, shared};
use serde_json::Value;

const SHEET: &str = r#"
drive = "valve"
cylinder = "16/10 x 100"
mass = "5.5 kg"
dead_volume = "15.29 cm3, 15.96 cm3"
supply = "70.0 bar"
command = "5.0 V"
rated_flow = "4.0 l/min"

[columns."Position [mm]"]
signal = "displacement"
zero = "retracted"
"#;

/// A bench by a simulator that shares no code with this program: its valve has dead zones of 0.30 V and 0.40 V.
#[test]
fn a_bench_is_read_in_one_command() {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/blind/bench/cases/01");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("sheet.toml"), SHEET).unwrap();
    let tables = ["identification.csv", "validation.csv"].map(|name| case.join(name).to_str().unwrap().to_string());
    let done = excavator(folder.path(), &["start", &tables[0], &tables[1], "--sheet", "sheet.toml"]);
    assert!(done.status.success(), "{}", complaint(&done));
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    for verb in ["model new", "import", "characterise", "compare", "diagnose"] {
        assert!(said.contains(&format!("  excavator {verb}")), "{verb} is missing in\n{said}");
    }
    assert_eq!(said.matches("Next, ").count(), 1, "{said}");
    let steady = std::fs::read_to_string(folder.path().join("start/steady.toml")).unwrap();
    let model: toml::Value = steady.parse::<toml::Table>().unwrap().into();
    let value = |name: &str| {
        let effects = model["effects"].as_array().unwrap().iter();
        let mut found = effects.filter_map(|effect| effect["parameters"].get(name)?.get("value")?.as_float());
        found.next().unwrap_or_else(|| panic!("no {name} in\n{steady}"))
    };
    assert!((value("dead_zone_positive") - 0.30).abs() < 0.05, "{steady}");
    assert!((value("dead_zone_negative") - 0.40).abs() < 0.05, "{steady}");
    assert!(folder.path().join("start/report.html").exists() && folder.path().join("start/study.json").exists());
}

#[test]
fn a_word_that_no_option_has_is_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("sheet.toml"), "drive = \"valve\"\nbore = \"16 mm\"\n").unwrap();
    std::fs::write(folder.path().join("t.csv"), "t [s],x [mm]\n0,1\n1,2\n").unwrap();
    let done = excavator(folder.path(), &["start", "t.csv", "--sheet", "sheet.toml"]);
    assert_eq!(done.status.code(), Some(1));
    assert!(complaint(&done).contains("--bore") && complaint(&done).contains("data sheet"), "{}", complaint(&done));
}

fn bench(name: &str) -> Option<PathBuf> {
    let folder = shared()?.join("practice-bench").join(name);
    folder.is_dir().then_some(folder)
}

/// What `characterise` reads of the tables of a bench, in the first cylinder.
fn read(folder: &Path, bench: &Path, tables: &[&str], model: &[&str]) -> Value {
    let sheet = bench.join("sheet.toml");
    let mut words = vec!["model", "new", "-o", "m.toml"];
    words.extend(model);
    assert!(excavator(folder, &words).status.success());
    let tables: Vec<String> = tables.iter().map(|name| bench.join(name).to_str().unwrap().to_string()).collect();
    let guess =
        ["import", &tables[0], "--guess", "--model", "m.toml", "--sheet", sheet.to_str().unwrap(), "-o", "map.toml"];
    assert!(excavator(folder, &guess).status.success());
    let mut words = vec!["characterise", "--model", "m.toml", "--map", "map.toml", "--json", "-"];
    words.extend(tables.iter().map(String::as_str));
    json(&excavator(folder, &words))["cylinders"][0].take()
}

fn close(value: &Value, truth: f64, share: f64) {
    let value = value.as_f64().unwrap_or(f64::NAN);
    assert!((value - truth).abs() <= share * truth.abs(), "{value} for {truth}");
}

/// Friction, leakage, gains and stops of a cylinder of 16 mm with a valve in volts, recorded at 5 kHz.
#[test]
fn a_small_bench_is_read_without_a_simulation() {
    let Some(bench) = bench("small-bench") else { return };
    let folder = tempfile::tempdir().unwrap();
    let model = ["--drive=valve", "--cylinder=16/10 x 200", "--command=10 V", "--supply=43.5 bar"];
    let found = read(folder.path(), &bench, &["run1.csv", "run2.csv", "run3.csv"], &model);
    let valve = &found["drive"];
    close(&valve["leakage"]["value"], 1.002e-12, 0.05);
    close(&valve["gains"][0]["value"], 6.397e-9, 0.02);
    close(&valve["gains"][1]["value"], 5.333e-9, 0.02);
    close(&found["stops"][0]["value"], -0.0946, 0.01);
    close(&found["stops"][1]["value"], 0.0972, 0.01);
}

/// The null of a crane's valve, at 5.69 V of 12 V, and its dead zones.
#[test]
fn the_null_of_a_crane_is_read() {
    let Some(bench) = bench("crane") else { return };
    let folder = tempfile::tempdir().unwrap();
    let model = [
        "--drive=load-sensing",
        "--cylinder=100/63 x 750",
        "--mass=4 t",
        "--slope=90",
        "--command=12 V",
        "--supply=180 bar",
    ];
    let found = read(folder.path(), &bench, &["lift1.csv", "lift2.csv"], &model);
    let valve = &found["drive"];
    close(&valve["null"]["value"], 5.690, 0.1 / 5.69);
    close(&valve["dead_zones"][0]["value"], 0.861, 0.15);
    close(&valve["dead_zones"][1]["value"], 0.827, 0.15);
    close(&valve["gains"][0]["value"], 3.028e-7, 0.03);
    close(&valve["gains"][1]["value"], 3.377e-7, 0.03);
    close(&valve["compensator_margin"]["value"], 1.2e6, 0.03);
    // The pump of this bench does not fall below 15 bar: lowering gets a larger drop than lifting.
    close(&valve["standby_pressure"]["value"], 1.5e6, 0.05);
}

/// Displacement and leakage of a pump that drives a cylinder.
#[test]
fn the_losses_of_a_pump_drive_are_read() {
    let Some(bench) = bench("pump-drive") else { return };
    let folder = tempfile::tempdir().unwrap();
    let model = ["--drive=pump", "--cylinder=50/20 x 300", "--slope=90"];
    let found = read(folder.path(), &bench, &["day1.csv", "day2.csv"], &model);
    let pump = &found["drive"];
    close(&pump["share"]["value"], 4.873 / 5.0, 0.02);
    close(&pump["leakage"]["value"], 7.619e-12, 0.05);
}

/// Gain, play, null and overlap of a servo valve, from its table and sheet alone.
#[test]
fn a_static_test_is_read_in_the_units_of_its_table() {
    let Some(bench) = bench("valve-test") else { return };
    let folder = tempfile::tempdir().unwrap();
    let table = bench.join("flow.txt");
    let tested = excavator(
        folder.path(),
        &["model", "valve", "--table", table.to_str().unwrap(), "--drop", "1000 psi", "--json", "-"],
    );
    let valve = json(&tested)["in_table_units"].take();
    assert!((valve["null"]["value"].as_f64().unwrap() + 0.7482).abs() < 0.05, "{valve}");
    for side in [&valve["sides"][0], &valve["sides"][1]] {
        close(&side["gain"]["value"], 0.3035, 0.02);
        close(&side["play"]["value"], 0.3210, 0.10);
        assert!((side["dead_zone"]["value"].as_f64().unwrap() - 0.0621).abs() < 0.03, "{side}");
    }
    let sheet = bench.join("sheet.toml");
    let words = ["start", table.to_str().unwrap(), "--sheet", sheet.to_str().unwrap()];
    let said = excavator(folder.path(), &words);
    assert!(said.status.success() && String::from_utf8_lossy(&said.stdout).contains("gpm/mA"), "{}", complaint(&said));
}

/// A test actuator under its own controller: one test predicts the other.
#[test]
fn a_positioner_is_predicted_from_its_reference() {
    let Some(bench) = bench("positioner") else { return };
    let folder = tempfile::tempdir().unwrap();
    let [first, other, sheet] =
        ["test1.csv", "test2.csv", "sheet.toml"].map(|name| bench.join(name).to_str().unwrap().to_string());
    let fit = json(&excavator(
        folder.path(),
        &["model", "position", "--identification", &first, "--validation", &other, "--json", "-"],
    ));
    assert!(fit["relative_errors"][0].as_f64().unwrap() < 0.02, "{fit}");
    let said = excavator(folder.path(), &["start", &first, &other, "--sheet", &sheet]);
    assert!(
        said.status.success() && String::from_utf8_lossy(&said.stdout).contains("Gain of the loop"),
        "{}",
        complaint(&said)
    );
}

/// `tests/run --all` runs these: a minute of computing each.
mod full {
    use super::*;

    /// What `start` says of a bench from its tables and sheet.
    fn said(name: &str, tables: &[&str]) -> Option<String> {
        let bench = bench(name)?;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| bench.join(name).to_str().unwrap().to_string();
        let (tables, sheet): (Vec<String>, String) = (tables.iter().map(|one| path(one)).collect(), path("sheet.toml"));
        let mut words = vec!["start"];
        words.extend(tables.iter().map(String::as_str));
        words.extend(["--sheet", &sheet]);
        let output = excavator(folder.path(), &words);
        assert!(output.status.success(), "{}", complaint(&output));
        Some(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    /// The row of an effect in the table of candidates.
    fn row<'s>(said: &'s str, effect: &str) -> &'s str {
        said.lines()
            .find(|line| line.starts_with(&format!("│ {effect} ")))
            .unwrap_or_else(|| panic!("{effect}: {said}"))
    }

    /// Of null, dead zones, compensator and lag, steady stretches read all but the lag.
    #[test]
    fn the_lag_of_a_cranes_valve_is_named() {
        let Some(said) = said("crane", &["lift1.csv", "lift2.csv"]) else { return };
        assert!(row(&said, "valve_lag").contains("selected"), "{said}");
    }

    /// The rod side of this drive gets what its area asks for, which the model of a single pump does not have.
    #[test]
    fn the_matched_flows_of_a_pump_drive_are_named() {
        let Some(said) = said("pump-drive", &["day1.csv", "day2.csv"]) else { return };
        assert!(row(&said, "matched_pump_flow").contains("selected"), "{said}");
        assert!(row(&said, "valve_lag").contains("selected"), "{said}");
    }
}
