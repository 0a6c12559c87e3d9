#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeMap;

use excavator_model::document::built_in;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use serde_json::{Value, json};

use super::*;
use crate::decision::Kind;
use crate::energy::Regime;
use crate::proposal::ProposalVerdict;
use crate::validation::{self, ErrorSums};

/// Every schema that describes an object, or one form of it, with its place.
fn objects<'s>(place: &str, schema: &'s Value, found: &mut Vec<(String, &'s Value)>) {
    if schema["properties"].is_object() {
        found.push((place.to_string(), schema));
    }
    for (name, one) in schema["$defs"].as_object().into_iter().flatten() {
        objects(&format!("{place} {name}"), one, found);
    }
    for one in ["oneOf", "anyOf"].iter().filter_map(|forms| schema[forms].as_array()).flatten() {
        objects(place, one, found);
    }
}

#[test]
fn every_field_of_every_result_is_described() {
    for (name, schema) in schemas() {
        let schema = Value::from(schema);
        let mut found = Vec::new();
        objects(name, &schema, &mut found);
        assert!(!found.is_empty(), "{name}");
        for (place, object) in found {
            for (key, field) in object["properties"].as_object().unwrap() {
                let is_tag = field["const"].is_string();
                assert!(is_tag || field["description"].is_string(), "{place}.{key} has no description: {field}");
            }
        }
    }
}

#[test]
fn a_name_means_the_same_in_every_schema() {
    let mut known: BTreeMap<String, Value> = BTreeMap::new();
    for (result, schema) in schemas() {
        let schema = Value::from(schema);
        for (name, one) in schema["$defs"].as_object().into_iter().flatten() {
            let earlier = known.entry(name.clone()).or_insert_with(|| one.clone());
            assert_eq!(earlier, one, "{name} of {result}");
        }
    }
    assert!(known.len() > 20, "{:?}", known.keys());
}

#[test]
fn names_in_json_are_those_of_the_program() {
    for regime in Regime::ALL {
        assert_eq!(serde_json::to_value(regime).unwrap(), json!(regime.name()));
    }
    for kind in [Kind::MissingEffect, Kind::Adequate, Kind::Unexplained] {
        assert_eq!(serde_json::to_value(kind).unwrap(), json!(kind.name()));
    }
    use ProposalVerdict::{Adequate, Law, MissingEffect, NoLaw};
    for kind in [Law, NoLaw, Adequate, MissingEffect] {
        assert_eq!(serde_json::to_value(kind).unwrap(), json!(kind.name()));
    }
}

fn comparison() -> (validation::Comparison, validation::Baselines) {
    let model = built_in("zx30u-arm").unwrap();
    let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 2e-3).collect();
    let mut recording = Recording::unmeasured("bag", time, &["arm"]);
    recording.tank_pressure.fill(3e5);
    recording.pump_flow.fill(3.8e-4);
    recording.cylinders[0].orifice_area = recording.time.iter().map(|t| 4e-5 * (1.9 * t).sin()).collect();
    let recording = simulate_from_rest(&model, &recording, &[0.0], Tolerances::default()).unwrap();
    let comparison = validation::compare(&model, &recording).unwrap();
    let baselines = validation::Baselines::of(&model, &recording, &comparison);
    (comparison, baselines)
}

#[test]
fn what_is_written_is_read_back_and_not_a_number_is_null() {
    let (mut comparison, baselines) = comparison();
    comparison.signals.iter_mut().for_each(|signal| signal.error = ErrorSums::of(&[1.0, 1.0], &[1.0, 1.0], f64::NAN));
    let result = Comparison::of(&comparison, &baselines, Some(&comparison), None);
    let written = serde_json::to_value(&result).unwrap();
    assert!(written["mean_nmse"].is_null() && written["repeat"].is_null());
    let first = &comparison.signals[0].name;
    assert!(written["signals"][first]["nmse"].is_null());
    assert_eq!(written["signals"][first]["rmse"], json!(0.0));
    assert_eq!(serde_json::from_value::<Comparison>(written).unwrap(), result);
}

#[test]
fn phases_are_told_of_one_recording_only() {
    let (comparison, _) = comparison();
    let both = [comparison.clone(), comparison];
    let steps = |comparisons| Refinement::of(Kind::Adequate, [(None, comparisons)], Some("better.toml"));
    let written = |comparisons| serde_json::to_value(steps(comparisons)).unwrap()["steps"][0].clone();
    let signal = &both[0].signals[0].name;
    assert!(written(&both[..1])["signals"][signal]["phases"].is_array());
    let two = written(&both);
    assert!(two["signals"][signal].get("phases").is_none() && two["added"].is_null(), "{two}");
    assert_eq!(written(&[])["signals"], json!({}));
}

#[test]
fn of_an_old_diagnosis_only_what_a_design_needs_must_be_there() {
    let old = json!({
        "verdict": "missing_effect",
        "candidates": [{"effect": "valve_lag", "cylinder": "arm", "tied_with_first": true, "more": 1}],
        "refitted": [{"name": "arm.inertia", "value": null}],
        "more": [],
    });
    let found: Diagnosis = serde_json::from_value(old.clone()).unwrap();
    assert_eq!((found.verdict, found.candidates.len()), (Kind::MissingEffect, 1));
    assert_eq!(found.refitted[0].value, None);
    for key in ["verdict", "candidates"] {
        let mut less = old.clone();
        less.as_object_mut().unwrap().remove(key);
        let error = serde_json::from_value::<Diagnosis>(less).unwrap_err().to_string();
        assert!(error.contains(key), "{error}");
    }
}

#[test]
fn a_refusal_is_told_from_what_was_found() {
    let refused = json!({"refused": "no steady stretch"});
    let found: Outcome<ChamberLeakage> = serde_json::from_value(refused.clone()).unwrap();
    assert!(matches!(&found, Outcome::Refused(why) if why.refused == "no steady stretch"));
    assert_eq!(serde_json::to_value(&found).unwrap(), refused);
    let estimate = json!({"value": 1.0, "std_error": null});
    let side = json!({"from_pump": estimate, "to_tank": estimate, "time_constant": estimate, "static_gain": estimate});
    let found: Outcome<ChamberLeakage> = serde_json::from_value(side.clone()).unwrap();
    assert!(matches!(found, Outcome::Found(_)));
    assert_eq!(serde_json::to_value(&found).unwrap(), side);
}
