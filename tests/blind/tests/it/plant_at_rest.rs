//! What is balanced and closed stays where it is.

use excavator_blind::plant::{Base, Effects, Extras, Plant};
use excavator_blind::run::{Lever, run};

fn tight(effects: Effects) -> Plant {
    let base =
        Base { internal_leakage: 0.0, external_leakage_cap: 0.0, external_leakage_rod: 0.0, ..Base::published() };
    Plant { base, effects, extras: Extras::none(), blind_spool: false, duration: 4.0, boom_holding_torque: 0.0 }
}

fn drift(plant: &Plant, begin: f64) -> (f64, f64) {
    let truth = run(plant, Lever::Replay(&[]), begin).unwrap();
    let away = |signal: &[f64]| signal.iter().map(|value| (value - signal[0]).abs()).fold(0.0, f64::max);
    (away(&truth.displacement), away(&truth.cap).max(away(&truth.rod)).max(away(&truth.pump)))
}

#[test]
fn a_tight_cylinder_holds_its_load() {
    for begin in [-0.2, -0.05, 0.0, 0.1, 0.25] {
        let (moved, pressure) = drift(&tight(Effects::default()), begin);
        println!("from {begin} m: {moved:.1e} m, {pressure:.1e} Pa");
        assert!(moved < 1e-9 && pressure < 1.0, "{begin}: {moved} m, {pressure} Pa");
    }
}

/// The boom's spring and the pin's contact are at rest too, once the pin has been pressed together.
#[test]
fn springs_start_balanced() {
    let mut effects = Effects::default();
    effects.foreign.boom_compliance = 2e-6;
    let (moved, _) = drift(&tight(effects), 0.05);
    assert!(moved < 1e-6, "boom: {moved} m");
    let mut effects = Effects::default();
    effects.foreign.pin_play = 2e-3;
    let (moved, _) = drift(&tight(effects), 0.05);
    println!("pin: {moved:.1e} m");
    assert!(moved < 1e-3, "pin: {moved} m");
}

/// With leakage the load sinks, and only the way that gravity pulls.
#[test]
fn a_leaking_cylinder_sinks() {
    let mut plant = tight(Effects::default());
    plant.base = Base::published();
    let truth = run(&plant, Lever::Replay(&[]), 0.0).unwrap();
    let (first, last) = (truth.displacement[0], truth.displacement[truth.displacement.len() - 1]);
    assert!((last - first).abs() > 1e-6 && (last - first).abs() < 0.02, "{first} -> {last}");
}
