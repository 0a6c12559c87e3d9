//! A contact that comes at another time in each recording, and an effect that is there all the time: both are named.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

mod common;

use common::add_noise;
use excavator_identification::diagnosis::{DiagnosisSettings, Verdict, diagnose};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Site, find};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const RATE: f64 = 500.0;
const ARM: Site = Site::Cylinder(0);

/// The arm with a loss in its hoses, and something that leans on it for three seconds from `begin` s on.
fn machine(begin: f64) -> Model {
    let mut model = built_in("zx30u-arm").unwrap();
    for (number, parameter) in model.parameters_mut().filter(|parameter| !parameter.known).enumerate() {
        parameter.value *= 1.0 + 0.1 * (1.7 * number as f64 + 0.4).sin();
    }
    for (name, values) in [("hose_loss", &[8e5][..]), ("external_contact", &[begin, 3.0, -280.0])] {
        model = model.with_effect(find(name).unwrap(), ARM).unwrap();
        for (parameter, value) in model.effects.last_mut().unwrap().parameters.iter_mut().zip(values) {
            parameter.value = *value;
        }
    }
    model
}

fn recorded(begin: f64, tempo: f64, duration: f64) -> Recording {
    let time: Vec<f64> = (0..(duration * RATE) as usize).map(|index| index as f64 / RATE).collect();
    let mut recording = Recording::unmeasured("leaned on", time, &["arm"]);
    recording.tank_pressure.fill(6e5);
    recording.pump_flow.fill(3.8e-4);
    let area = |t: f64| 6e-5 * (tempo * t).sin() + 4e-5 * (2.7 * tempo * t).sin();
    recording.cylinders[0].orifice_area = recording.time.iter().map(|&t| area(t)).collect();
    let mut seen =
        simulate_from_rest(&machine(begin), &recording, &[0.05], Tolerances::default().scaled(0.05)).unwrap();
    let random = &mut ChaCha8Rng::seed_from_u64(begin as u64);
    let arm = &mut seen.cylinders[0];
    arm.orifice_command = recording.cylinders[0].orifice_area.clone();
    arm.velocity.fill(f64::NAN);
    arm.joint_angle.fill(f64::NAN);
    for (signal, level) in [
        (&mut arm.displacement, 5e-5),
        (&mut arm.cap_pressure, 2e3),
        (&mut arm.rod_pressure, 2e3),
        (&mut arm.orifice_area, 2e-7),
        (&mut seen.pump_pressure, 2e3),
    ] {
        add_noise(random, signal, level);
    }
    seen
}

#[test]
#[ignore = "half a minute; tests/run --long"]
fn both_are_named() {
    let (identification, validation) = (recorded(14.0, 2.9, 24.0), recorded(4.0, 3.4, 14.0));
    let model = built_in("zx30u-arm").unwrap();
    let settings = DiagnosisSettings::default();
    let found = diagnose(&model, &[&identification], &[&validation], &settings, &|_, _| {}).unwrap();
    let mut names: Vec<&str> = found.chain.iter().map(|link| link.name()).collect();
    names.sort_unstable();
    assert_eq!((found.verdict, &names[..]), (Verdict::MissingEffect, &["external_contact", "hose_loss"][..]));
    let left = found.chain.last().unwrap().validation.loss();
    assert!(left < 0.5, "{left}");
}
