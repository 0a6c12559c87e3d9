//! Swapped sensors of the two chambers are found on any machine from its motion and its areas, without a pressure of the supply.

use crate::common::measure;
use excavator_identification::checks::{CheckError, check};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::machine::Supply;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use excavator_model::template::examples;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// A machine at work for 24 s, its input two sines of these shares of the full command, as good instruments see it. The pressure
/// of the supply is not measured.
fn at_work(model: &Model, tempo: f64, seed: u64) -> Recording {
    let machine = &model.machine;
    let names: Vec<&str> = machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
    let time: Vec<f64> = (0..4800).map(|sample| f64::from(sample) / 200.0).collect();
    let mut recording = Recording::unmeasured("work", time, &names);
    recording.tank_pressure.fill(machine.supply.tank_pressure());
    recording.pump_flow.fill(machine.supply.pump_flow());
    for (number, (signals, cylinder)) in recording.cylinders.iter_mut().zip(&machine.cylinders).enumerate() {
        let full = cylinder.chambers.as_ref().unwrap().full_command();
        let slower = tempo / (1.0 + 0.3 * number as f64);
        let input = |t: f64| full * (0.4 * (slower * t).sin() + 0.2 * (2.7 * slower * t).sin());
        signals.orifice_area = recording.time.iter().map(|&t| input(t)).collect();
    }
    let start = vec![0.0; names.len()];
    let mut seen = simulate_from_rest(model, &recording, &start, Tolerances::default()).unwrap();
    measure(&mut ChaCha8Rng::seed_from_u64(seed), &mut seen);
    if !matches!(machine.supply, Supply::None) {
        seen.pump_pressure.fill(f64::NAN);
    }
    seen
}

fn swapped(recording: &Recording) -> Recording {
    let mut swapped = recording.clone();
    swapped.cylinders.iter_mut().for_each(|one| std::mem::swap(&mut one.cap_pressure, &mut one.rod_pressure));
    swapped
}

/// Machines, and whether the check can see swapped sensors of them: the load of a coupled joint also follows the other one, so
/// that neither order of the pressures explains it.
fn machines() -> Vec<(Model, bool)> {
    let template = |name: &str| examples().into_iter().find(|model| model.machine.name == name).unwrap();
    let built_in = |name: &str| built_in(name).unwrap();
    vec![
        (built_in("zx30u-arm"), true),
        (built_in("servo-bench"), true),
        (template("pump-driven"), true),
        (template("pump-driven-double-rod"), true),
        (template("load-sensing"), true),
        (built_in("zx30u"), false),
    ]
}

/// Neither concerns the order of the sensors: a bench may end at a stop.
fn accepted() -> [String; 2] {
    ["stuck".into(), "beyond-stroke".into()]
}

#[test]
fn swapped_sensors_are_refused_without_a_pressure_of_the_supply() {
    for (model, is_seen) in machines() {
        let found = check(&model, &swapped(&at_work(&model, 4.4, 2)), &accepted());
        let is_refused = matches!(&found, Err(CheckError::SwappedChambers { given, swapped, .. }) if given > swapped);
        assert_eq!(is_refused, is_seen, "{}: {found:?}", model.machine.name);
        assert!(is_seen || found.is_ok(), "{}: {found:?}", model.machine.name);
    }
}

#[test]
fn sensors_in_their_places_are_not_refused() {
    for (model, _) in machines() {
        for (tempo, seed) in [(1.3, 1), (2.9, 2), (4.4, 3)] {
            let found = check(&model, &at_work(&model, tempo, seed), &accepted());
            assert!(found.is_ok(), "{} at {tempo} rad/s: {found:?}", model.machine.name);
        }
    }
}
