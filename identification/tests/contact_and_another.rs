//! A contact that comes at another time in each recording, and an effect that is there all the time: both are named.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

mod common;

use common::{measure, off_the_data_sheet, with};
use excavator_identification::diagnosis::{DiagnosisSettings, Verdict, diagnose};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::Site;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const RATE: f64 = 500.0;
const ARM: Site = Site::Cylinder(0);

/// The arm with a loss in its hoses, and something that leans on it for three seconds from `begin` s on.
fn machine(begin: f64) -> Model {
    let lossy = with(&off_the_data_sheet("zx30u-arm", 0.1), "hose_loss", ARM, &[8e5]);
    with(&lossy, "external_contact", ARM, &[begin, 3.0, -280.0])
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
    seen.cylinders[0].orifice_command = recording.cylinders[0].orifice_area.clone();
    measure(&mut ChaCha8Rng::seed_from_u64(begin as u64), &mut seen);
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
