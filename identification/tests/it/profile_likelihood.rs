//! Intervals of parameters that recordings hardly show.

use crate::common::add_noise;
use excavator_identification::fit::{Fit, FitSettings, ProfileInterval, fit, profile};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The paper's arm under a command for 8 s at 250 Hz, its sensors with noise.
fn measured(command: impl Fn(f64) -> f64, seed: u64) -> Recording {
    let time: Vec<f64> = (0..2000).map(|index| f64::from(index) * 4e-3).collect();
    let mut recording = Recording::unmeasured("experiment", time, &["arm"]);
    recording.tank_pressure.fill(3e5);
    recording.pump_flow.fill(3.8e-4);
    recording.cylinders[0].orifice_area = recording.time.iter().map(|&t| command(t)).collect();
    let model = built_in("zx30u-arm").unwrap();
    let mut recording = simulate_from_rest(&model, &recording, &[0.1], Tolerances::default().scaled(0.05)).unwrap();
    let arm = &mut recording.cylinders[0];
    arm.velocity.fill(f64::NAN);
    arm.joint_angle.fill(f64::NAN);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut add = |signal: &mut Vec<f64>, level: f64| add_noise(&mut random, signal, level);
    add(&mut arm.displacement, 5e-5);
    add(&mut arm.cap_pressure, 2e4);
    add(&mut arm.rod_pressure, 2e4);
    add(&mut recording.pump_pressure, 2e4);
    recording
}

/// All parameters known but these.
fn model(free: &[&str]) -> Model {
    let mut model = built_in("zx30u-arm").unwrap();
    let names = model.parameter_names();
    for (name, parameter) in names.iter().zip(model.parameters_mut()) {
        parameter.known = !free.contains(&name.as_str());
    }
    model
}

fn profiled(free: &[&str], recording: &Recording, name: &str) -> (Fit, ProfileInterval) {
    let settings = FitSettings::default();
    let best = fit(&model(free), &[recording], &settings).unwrap();
    let index = best.model.parameter_names().iter().position(|own| own == name).unwrap();
    let found = profile(&best, &[recording], &settings, index).unwrap();
    (best, found)
}

fn swing(t: f64) -> f64 {
    6e-5 * (3.0 * t).sin() + 3e-5 * (7.0 * t).sin()
}

#[test]
fn where_a_model_is_linear_the_interval_is_that_of_the_standard_error() {
    let recording = measured(swing, 1);
    let (best, found) = profiled(&["arm.viscous_damping", "arm.coulomb_friction"], &recording, "arm.viscous_damping");
    let parameter = best.model.parameters().nth(found.index).unwrap().1;
    let error = parameter.standard_error.unwrap();
    let (lower, upper) = (found.lower.unwrap(), found.upper.unwrap());
    for (end, side) in [(lower, -1.0), (upper, 1.0)] {
        let distance = side * (end - parameter.value) / error;
        assert!((1.3..2.8).contains(&distance), "{distance}: {found:?}");
    }
    assert!((lower..upper).contains(&13_000.0), "{found:?}");
}

/// All parameters known, and an effect that the machine has not, with these values; the last of them is asked for.
fn profiled_addition(effect: &str, values: &[f64]) -> ProfileInterval {
    let recording = measured(swing, 2);
    let mut model = model(&[]).with_effect(&Catalogue::built_in().find(effect).unwrap(), Site::PumpLine).unwrap();
    let own = model.effects.last_mut().unwrap();
    for (parameter, value) in own.parameters.iter_mut().zip(values) {
        parameter.value = *value;
        parameter.known = true;
    }
    own.parameters.last_mut().unwrap().known = false;
    let index = model.parameters().count() - 1;
    let settings = FitSettings::default();
    let best = fit(&model, &[&recording], &settings).unwrap();
    profile(&best, &[&recording], &settings, index).unwrap()
}

#[test]
fn a_leakage_that_is_not_there_is_bounded_above_and_open_below() {
    let found = profiled_addition("pump_leakage", &[1e-13]);
    assert_eq!(found.lower, None, "{found:?}");
    // A hundredth of the pump's flow at 10 MPa would be 4e-13.
    assert!((1e-15..4e-12).contains(&found.upper.unwrap()), "{found:?}");
}

#[test]
fn what_a_recording_does_not_show_takes_nothing_from_what_is_known_of_the_others() {
    let recording = measured(swing, 3);
    let errors = |model: &Model| -> Vec<f64> {
        let found = fit(model, &[&recording], &FitSettings::default()).unwrap();
        found.model.parameters().filter_map(|(_, parameter)| parameter.standard_error).collect()
    };
    let alone = model(&["arm.viscous_damping", "arm.coulomb_friction"]);
    let mut more = alone.with_effect(&Catalogue::built_in().find("relief_valve").unwrap(), Site::PumpLine).unwrap();
    for (parameter, value) in more.effects.last_mut().unwrap().parameters.iter_mut().zip([34e6, 1e-9]) {
        parameter.value = value;
    }
    let (alone, more) = (errors(&alone), errors(&more));
    assert_eq!(more[2..], [f64::INFINITY; 2], "{more:?}");
    for (error, same) in more.iter().zip(&alone) {
        assert!((error / same - 1.0).abs() < 0.1, "{more:?}, {alone:?}");
    }
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn what_a_recording_does_not_show_is_open_on_both_sides() {
        // The relief valve opens at a pressure that is never reached.
        let found = profiled_addition("relief_valve", &[34e6, 1e-9]);
        assert!(!found.is_identifiable(), "{found:?}");
    }
}
