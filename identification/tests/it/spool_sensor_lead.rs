//! A spool sensor that is read earlier than the others: found along the way, taken into account, never named as missing.

use crate::common::{measure, off_the_data_sheet};
use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_identification::refinement::{Additions, refine};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const RATE: f64 = 500.0;

/// Opening in m²: sines, and edges of some forty milliseconds.
fn area(time: f64) -> f64 {
    let edge = |at: f64| 0.5 * (1.0 + ((time.rem_euclid(5.0) - at) / 2e-2).tanh());
    let steps = 6e-5 * (edge(1.0) - edge(1.5)) - 6e-5 * (edge(2.2) - edge(2.7));
    steps + 3e-5 * (5.3 * time).sin() * (edge(3.0) - edge(4.8))
}

fn machine() -> Model {
    off_the_data_sheet("zx30u-arm", 0.1)
}

/// What instruments report of the machine; the spool's reads `lead` s ahead of the others.
fn recorded(model: &Model, lead: f64, seed: u64) -> Recording {
    let time: Vec<f64> = (0..(15.0 * RATE) as usize).map(|index| index as f64 / RATE).collect();
    let mut recording = Recording::unmeasured("machine", time, &["arm"]);
    recording.tank_pressure.fill(6e5);
    recording.pump_flow.fill(3.8e-4);
    recording.cylinders[0].orifice_area = recording.time.iter().map(|&t| area(t)).collect();
    let mut seen = simulate_from_rest(model, &recording, &[0.05], Tolerances::default().scaled(0.05)).unwrap();
    seen.cylinders[0].orifice_area = seen.time.iter().map(|&t| area(t + lead)).collect();
    seen.cylinders[0].orifice_command = seen.time.iter().map(|&t| area(t)).collect();
    measure(&mut ChaCha8Rng::seed_from_u64(seed), &mut seen);
    seen
}

/// The built-in model fitted to what the machine was seen to do.
fn fitted(lead: f64) -> Model {
    let machine = machine();
    let (identification, validation) = (recorded(&machine, lead, 1), recorded(&machine, lead, 2));
    let settings = DiagnosisSettings::default();
    let nothing = Additions::Named(Vec::new());
    let given = built_in("zx30u-arm").unwrap();
    refine(&given, &[&identification], &[&validation], &nothing, &settings, "", &|_, _| {}).unwrap().model
}

fn relative_error(model: &Model, parameter: &str) -> f64 {
    model.value_of(parameter).unwrap() / machine().value_of(parameter).unwrap() - 1.0
}

#[test]
fn instruments_that_are_read_at_once_need_no_lead() {
    assert_eq!(fitted(0.0).value_of("arm.spool_lead_time"), None);
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn a_part_of_a_sample_is_found_and_bends_no_bulk_modulus() {
        for lead in [4e-4, -3e-4] {
            let model = fitted(lead);
            let found = model.value_of("arm.spool_lead_time").expect("the lead is part of the fit");
            // A twentieth of the sample interval.
            assert!((found - lead).abs() < 1e-4, "{found:e} s, should be {lead:e} s");
            for parameter in ["arm.bulk_modulus", "pump.bulk_modulus"] {
                let error = relative_error(&model, parameter);
                assert!(error.abs() < 0.015, "{parameter} {:.2} % off with a lead of {lead:e} s", 100.0 * error);
            }
        }
    }

    #[test]
    fn a_valve_that_lags_is_left_to_the_diagnosis() {
        // 1.3 ms are the range of the prior: the rest is missing physics.
        let lead = fitted(8e-3).value_of("arm.spool_lead_time").unwrap_or(0.0);
        assert!(lead < 1.301e-3, "{lead:e}");
    }
}
