//! A load that is picked up in the middle of a recording is named; one that is always there is a heavier arm.

use crate::common::{off_the_data_sheet, steered, with};
use excavator_identification::decision::{Kind, Reason};
use excavator_identification::diagnosis::{Diagnosis, DiagnosisSettings, diagnose};
use excavator_model::document::built_in;
use excavator_model::effects::Site;
use excavator_model::recording::Recording;

/// Mass, kg, and its distance from the joint, m.
const LOAD: [f64; 2] = [60.0, 1.7];

/// The arm with a load on it from `begin` (s) on.
fn recorded(begin: f64, tempo: f64, duration: f64) -> Recording {
    let arm = off_the_data_sheet("zx30u-arm", 0.1);
    let machine = with(&arm, "payload", Site::Cylinder(0), &[LOAD[0], LOAD[1], begin, 1e9]);
    steered(&machine, tempo, duration, (begin + 5.0) as u64)
}

fn diagnosed(begins: [f64; 2]) -> Diagnosis {
    let (identification, validation) = (recorded(begins[0], 2.9, 24.0), recorded(begins[1], 3.4, 14.0));
    let model = built_in("zx30u-arm").unwrap();
    diagnose(&model, &[&identification], &[&validation], &DiagnosisSettings::default(), &|_, _| {}).unwrap()
}

#[test]
fn a_load_that_is_picked_up_is_named() {
    let found = diagnosed([9.3, 5.6]);
    let names: Vec<&str> = found.selected().iter().map(|one| one.name()).collect();
    assert_eq!((found.verdict.kind, &names[..]), (Kind::MissingEffect, &["payload"][..]));
    assert_eq!(found.verdict.set.len(), 1);
    let best = found.best();
    assert!(best.validation.loss() < 0.1, "{}", best.validation.loss());
    for (parameter, wanted, margin) in
        [("arm.payload_mass", LOAD[0], 1.0), ("arm.payload_distance", LOAD[1], 0.03), ("arm.payload_start", 9.3, 0.05)]
    {
        let value = best.fit.model.value_of(parameter).unwrap();
        assert!((value - wanted).abs() < margin, "{parameter} = {value}, not {wanted}");
    }
}

#[test]
fn a_load_that_is_always_there_is_a_heavier_arm() {
    let found = diagnosed([-1.0, -1.0]);
    assert_eq!(found.verdict.kind, Kind::Adequate);
    assert!(matches!(found.verdict.reasons[0], Reason::WithinNoise { .. }), "{:?}", found.verdict.reasons);
    let inertia = found.given().fit.model.value_of("arm.inertia").unwrap();
    let wanted = off_the_data_sheet("zx30u-arm", 0.1).value_of("arm.inertia").unwrap() + LOAD[0] * LOAD[1] * LOAD[1];
    assert!((inertia / wanted - 1.0).abs() < 0.01, "{inertia} {wanted}");
}
