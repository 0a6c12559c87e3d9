//! The whole path on recordings by an independent simulator and on a real drive.

use crate::common;
use std::path::Path;

use crate::common::{excavator, json, shared};
use serde_json::Value;

fn diagnose(case: &Path, model: &str) -> Value {
    let (identification, validation) = (case.join("identification"), case.join("validation"));
    let words = [
        "diagnose",
        "--model",
        model,
        "--json",
        "-",
        "--identification",
        identification.to_str().unwrap(),
        "--validation",
        validation.to_str().unwrap(),
    ];
    json(&excavator(case, &words))
}

/// The verdict on a recording of a machine of another size, or on strokes onto the stops, is the right one.
fn is_judged_right(case: &str) {
    let Some(shared) = shared() else { return };
    let folder = shared.join("practice-sizes");
    let Ok(text) = std::fs::read_to_string(folder.join("answers.json")) else {
        println!("skipped: {} is not here", folder.display());
        return;
    };
    let answers: Value = serde_json::from_str(&text).unwrap();
    let wanted = &answers[case]["effects"];
    let diagnosis = diagnose(&folder.join(case), folder.join(case).join("model.toml").to_str().unwrap());
    let Some(wanted) = wanted.get(0) else {
        assert_eq!(diagnosis["verdict"], "adequate", "{case}: {diagnosis:#}");
        return;
    };
    assert_eq!(diagnosis["verdict"], "missing_effect", "{case}: {diagnosis:#}");
    let first = &diagnosis["candidates"][0];
    assert_eq!((&first["effect"], &first["tied_with_first"]), (wanted, &Value::Bool(false)), "{case}");
    let error = |key: &str| first[key].as_f64().unwrap();
    assert!(error("validation_error_after") < 0.01 * error("validation_error_before"), "{case}");
}

#[test]
#[ignore = "two minutes; tests/run --long"]
fn so_are_larger_machines_and_strokes_onto_stops() {
    ["r01", "r02", "r03", "r04", "r05"].into_iter().for_each(is_judged_right);
}

fn answers(shared: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(shared.join("practice/answers.json")).unwrap()).unwrap()
}

/// The right model leaves the sensors' noise and little else; p05, where a chamber touches the vapour limit, leaves most.
fn assert_leaves_noise(loss: &Value) {
    assert!(loss.as_f64().unwrap().abs() < 0.25, "{loss}");
}

/// The hidden effect is named first, alone, and named as missing.
fn assert_found(case: &str) {
    let Some(shared) = shared() else { return };
    let wanted = answers(&shared)[case]["effects"][0].as_str().unwrap().to_string();
    let diagnosis = diagnose(&shared.join("practice").join(case), "zx30u-arm");
    assert_eq!(diagnosis["verdict"], "missing_effect", "{diagnosis:#}");
    let first = &diagnosis["candidates"][0];
    assert_eq!(first["effect"], wanted.as_str(), "{diagnosis:#}");
    assert_eq!(first["tied_with_first"], false);
    let (before, after) = (&first["validation_error_before"], &first["validation_error_after"]);
    println!("{case}: {wanted}, validation error {before} -> {after}");
    assert!(after.as_f64().unwrap() < 0.2 * before.as_f64().unwrap());
    assert_leaves_noise(&diagnosis["effects"][0]["log_error_ratio_after"]);
}

#[test]
fn nothing_missing_is_adequate() {
    let Some(shared) = shared() else { return };
    let diagnosis = diagnose(&shared.join("practice/p00"), "zx30u-arm");
    assert_eq!(diagnosis["verdict"], "adequate", "{diagnosis:#}");
    assert_eq!(diagnosis["candidates"].as_array().unwrap().len(), 0);
    assert_eq!(diagnosis["reasons"][0]["reason"], "within_noise");
    assert_leaves_noise(&diagnosis["log_error_ratio"]);
}

#[test]
fn dead_zone_is_found() {
    assert_found("p01");
}

#[test]
#[ignore = "half a minute each; tests/run --long"]
fn all_other_single_effects_are_found() {
    for case in ["p02", "p03", "p04", "p05", "p06", "p07"] {
        assert_found(case);
    }
}

#[test]
#[ignore = "a minute; tests/run --long"]
fn both_of_two_effects_are_found_and_the_model_file_says_so() {
    let Some(shared) = shared() else { return };
    let case = shared.join("practice/p08");
    let folder = tempfile::tempdir().unwrap();
    let (identification, validation) = (case.join("identification"), case.join("validation"));
    let words = [
        "refine",
        "--model",
        "zx30u-arm",
        "--auto",
        "--json",
        "-",
        "-o",
        "better.toml",
        "--identification",
        identification.to_str().unwrap(),
        "--validation",
        validation.to_str().unwrap(),
    ];
    let result = json(&excavator(folder.path(), &words));
    let added: Vec<&str> =
        result["steps"].as_array().unwrap().iter().filter_map(|step| step["added"].as_str()).collect();
    assert_eq!(added.len(), 2, "{result:#}");
    assert!(added.contains(&"hose_loss@arm") && added.contains(&"valve_dead_zone@arm"), "{added:?}");
    let model = std::fs::read_to_string(folder.path().join("better.toml")).unwrap();
    assert!(model.contains("added hose_loss@arm") && model.contains("effect = \"valve_dead_zone\""));
    let words = ["compare", "--model", "better.toml", "--json", "-", "--bag", validation.to_str().unwrap()];
    let comparison = json(&excavator(folder.path(), &words));
    for signal in ["arm.displacement", "arm.cap_pressure", "arm.rod_pressure", "pump_pressure"] {
        let nmse = comparison["signals"][signal]["nmse"].as_f64().unwrap();
        assert!(nmse < 5e-3, "{signal}: {nmse}");
    }
}

#[test]
#[ignore = "several minutes; tests/run --long"]
fn two_joints_with_nothing_hidden_are_adequate() {
    let Some(shared) = shared() else { return };
    let diagnosis = diagnose(&shared.join("practice/p09"), "zx30u");
    assert_eq!(diagnosis["verdict"], "adequate", "{diagnosis:#}");
    assert_eq!(diagnosis["reasons"][0]["reason"], "within_noise");
    assert_leaves_noise(&diagnosis["log_error_ratio"]);
}

#[test]
fn base_parameters_and_their_intervals() {
    let Some(shared) = shared() else { return };
    let bag = shared.join("practice/p00/identification");
    let folder = tempfile::tempdir().unwrap();
    let words = ["identify", "--model", "zx30u-arm", "--json", "-", "--bag", bag.to_str().unwrap()];
    let result = json(&excavator(folder.path(), &words));
    let truth = &answers(&shared)["p00"]["truth"];
    let names = [
        ("arm.inertia", "J2"),
        ("arm.gravity_moment", "W2"),
        ("arm.bulk_modulus", "b_2"),
        ("arm.flow_gain_cap", "Cfp_2"),
        ("arm.flow_gain_rod", "Cfm_2"),
        ("pump.bypass_flow_gain", "Cft"),
        ("arm.viscous_damping", "Fd_2"),
        ("arm.coulomb_friction", "Fc_2"),
        ("pump.bulk_modulus", "bp"),
        ("arm.internal_leakage", "Ci_2"),
        ("arm.external_leakage_cap", "Cep_2"),
        ("arm.external_leakage_rod", "Cem_2"),
    ];
    let mut inside = 0;
    for (number, (name, symbol)) in names.iter().enumerate() {
        let found = result["parameters"].as_array().unwrap().iter().find(|p| p["name"] == *name).unwrap();
        let (value, error) = (found["value"].as_f64().unwrap(), found["std_error"].as_f64().unwrap());
        let truth = truth[symbol].as_f64().unwrap();
        println!(
            "{name:28} {value:.4e} ± {:.1e}, true {truth:.4e}: {:+.2} %",
            1.96 * error,
            100.0 * (value / truth - 1.0)
        );
        if number < 7 {
            assert!((value / truth - 1.0).abs() < 0.1, "{name}");
        }
        inside += usize::from((value - truth).abs() <= 1.96 * error);
    }
    println!("{inside} of 12 intervals contain the truth");
    assert!(inside >= 9, "{inside} of 12");
}

/// Published reference of the EMPS benchmark (Janot, Gautier, Brunot 2019): mass, viscous, Coulomb, offset.
#[test]
fn emps_agrees_with_the_published_values() {
    let Some(shared) = shared() else { return };
    let bag = shared.join("realdata/emps/identification");
    let folder = tempfile::tempdir().unwrap();
    let words = ["identify", "--model", "emps", "--method", "weak-form", "--json", "-", "--bag", bag.to_str().unwrap()];
    let result = json(&excavator(folder.path(), &words));
    for (name, published, within) in [
        ("load.mass", 95.1089, 0.01),
        ("load.viscous_damping", 203.5034, 0.01),
        ("load.coulomb_friction", 20.3935, 0.01),
        ("load.force_offset", -3.1648, 0.03),
    ] {
        let found = result["parameters"].as_array().unwrap().iter().find(|p| p["name"] == name).unwrap();
        let value = found["value"].as_f64().unwrap();
        println!("{name}: {value:.4} ± {}, published {published}", 1.96 * found["std_error"].as_f64().unwrap());
        assert!((value / published - 1.0).abs() < within, "{name}: {value}");
    }
}

#[test]
fn demo_tells_its_story() {
    let folder = tempfile::tempdir().unwrap();
    let output = excavator(folder.path(), &["demo", "--seed", "1", "-o", "story"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{}", common::complaint(&output));
    let sealed = text.split("the hidden effect is ").nth(1).and_then(|rest| rest.split('.').next()).unwrap();
    assert!(text.contains(&format!("+ {sealed}@")), "{text}");
    for file in ["report.html", "refined-model.toml", "identification/metadata.yaml", "validation/metadata.yaml"] {
        assert!(folder.path().join("story").join(file).exists(), "{file}");
    }
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn a_machine_ten_times_smaller_is_judged_like_one_of_usual_size() {
        is_judged_right("r00");
    }
}
