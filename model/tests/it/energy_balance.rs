//! The energy balance along simulated trajectories, and the formulas of \[A\] Eq. 11.

use crate::common;
use std::collections::HashSet;

use crate::common::Random;
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::Catalogue;
use excavator_model::energy::{EffectPower, Ledger, ledger};
use excavator_model::equations::{Inputs, System};
use excavator_model::simulation::{InputSignals, Integrator, Tolerances};

/// How long a machine is driven and the time between two looks at the powers, s: shorter where valves without an opening of their own
/// leave little time to a pressure, and for the stiff oil of a motor.
fn duration_and_interval(model: &Model) -> (f64, f64) {
    let has = |name: &str| model.effects.iter().any(|effect| effect.name() == name);
    if has("shuttle_valve") && has("charge_check_valve") {
        (0.1, 5e-6)
    } else if ["shuttle_valve", "charge_check_valve", "vented_rod_side"].into_iter().any(has) {
        (0.2, 1e-5)
    } else if model.machine.cylinders[0].is_motor() && model.machine.cylinders.len() == 1 {
        (0.3, 5e-5)
    } else {
        (0.5, 1e-4)
    }
}

/// Largest difference between stored energy and the integral of the powers over a driven trajectory, relative to the
/// energy that was turned over: the integral of the sizes of all powers.
fn imbalance(model: &Model) -> f64 {
    let area = |number: usize, t: f64| {
        let phase = 1.3 * number as f64;
        8e-5 * (std::f64::consts::TAU * 1.5 * t + phase).sin()
    };
    let (duration, interval) = duration_and_interval(model);
    let recording =
        common::driven(model, duration, interval, area, |t| 800.0 * (std::f64::consts::TAU * 5.0 * t).sin());
    let signals = InputSignals::from_recording(model, &recording).unwrap();
    let system = System::new(model);
    let parameters = model.parameter_values();
    let mut integrator = Integrator::new(&system, &parameters, &[], Tolerances::default().scaled(1e-6));
    let mut state = common::at_rest(&system);
    for (effect, &(first, states)) in model.effects.iter().zip(&system.layout().effect_states) {
        if let excavator_model::effects::Site::Cylinder(number) = effect.site {
            state[first..first + states].fill(area(number, 0.0));
        }
    }
    let mut inputs = Inputs::zero(system.layout().joints);
    let mut books: Vec<(f64, f64, f64)> = Vec::with_capacity(signals.len());
    for index in 0..signals.len() {
        signals.between(index, 0.0, &mut inputs);
        let book: Ledger = ledger(&system, &parameters, &state, &inputs);
        let turned_over = book.pump_power.abs()
            + book.rod_force_power.abs()
            + book.effects.iter().map(|effect| effect.total().abs()).sum::<f64>();
        books.push((book.stored(), book.balance(), turned_over));
        if index + 1 < signals.len() {
            integrator.advance(&signals, index, &mut state, None).unwrap();
        }
    }
    // Simpson's rule over pairs of samples.
    let (mut supplied, mut turned_over, mut worst) = (0.0, 0.0, 0.0_f64);
    let start = books[0].0;
    for three in books.windows(3).step_by(2) {
        let weighted = |part: fn(&(f64, f64, f64)) -> f64| {
            interval / 3.0 * (part(&three[0]) + 4.0 * part(&three[1]) + part(&three[2]))
        };
        supplied += weighted(|book| book.1);
        turned_over += weighted(|book| book.2);
        worst = worst.max((three[2].0 - start - supplied).abs());
    }
    assert!(turned_over > 0.1, "nothing happens: {turned_over} J");
    worst / turned_over
}

#[test]
fn balance_closes_along_trajectories_of_the_nominal_models() {
    for model in common::machines() {
        let imbalance = imbalance(&model);
        println!("{}: {imbalance:.1e}", model.machine.name);
        assert!(imbalance <= 1e-6, "{}: {imbalance:e}", model.machine.name);
    }
}

/// Models with one effect more than their machine has.
fn with_one_more() -> Vec<(Model, usize)> {
    let machines = common::machines();
    let mut models = common::every_effect_everywhere();
    models.retain(|(model, _)| {
        let machine = machines.iter().find(|base| base.machine.name == model.machine.name).unwrap();
        machine.effects.len() != model.effects.len()
    });
    models
}

fn check(models: Vec<(Model, usize)>) {
    common::each(models, |(model, index)| {
        let imbalance = imbalance(&model);
        assert!(imbalance <= 1e-6, "{}: {imbalance:e}", common::label(&model, index));
    });
}

/// Each effect at the first place that has room for it.
#[test]
fn balance_closes_along_trajectories_with_each_effect_added() {
    let mut seen = HashSet::new();
    let mut models = with_one_more();
    models.retain(|(model, effect)| seen.insert(model.effects[*effect].name().to_string()));
    seen.extend(common::machines().iter().flat_map(|machine| &machine.effects).map(|effect| effect.name().to_string()));
    common::catalogue()
        .iter()
        .for_each(|physics| assert!(seen.contains(&*physics.card().name), "{}", physics.card().name));
    check(models);
}

#[test]
#[ignore = "three minutes; tests/run --long"]
fn balance_closes_along_trajectories_with_each_effect_added_everywhere() {
    check(with_one_more());
}

fn power<'a>(book: &'a Ledger, effect: &str) -> &'a EffectPower {
    book.effects.iter().find(|power| power.effect == effect).unwrap()
}

/// \[A\] Eq. 9 and 11, written out once more by hand for the arm.
#[test]
fn the_arm_has_the_energies_of_the_paper() {
    let model = built_in("zx30u-arm").unwrap();
    let system = System::new(&model);
    let parameters = model.parameter_values();
    let mut random = Random(11);
    for _ in 0..50 {
        let mut state = common::random_state(&system, &mut random);
        state[0] = model.machine.cylinders[0].linkage.joint(random.between(-0.29, 0.29));
        state[1] = random.between(0.1, 0.5) * if random.unit() < 0.5 { -1.0 } else { 1.0 };
        for pressure in &mut state[2..5] {
            *pressure = random.between(1e4, 2e7);
        }
        let inputs = common::random_inputs(&model.machine, &mut random);
        let book = ledger(&system, &parameters, &state, &inputs);
        let (q, rate, cap, rod, pump) = (state[0], state[1], state[2], state[3], state[4]);
        let (b, bp) = (9.6e8, 6.5e7);
        let linkage = &model.machine.cylinders[0].linkage;
        let (s, v) = (linkage.displacement(q), linkage.lever(q) * rate);
        let e = |p: f64| (p / b).exp_m1();
        let h = |p: f64, b: f64| b * (p / b).exp_m1() - p;
        let volumes = (3.4e-4 + (0.3 + s) * 3.8e-3, 3.0e-4 + (0.3 - s) * 2.6e-3);
        let close = |what: &str, found: f64, wanted: f64| {
            assert!((found - wanted).abs() <= 1e-7 * wanted.abs(), "{what}: {found}, by hand {wanted}");
        };
        let stored = book.cylinders[0];
        close("kinetic", stored.kinetic, 0.5 * 230.0 * rate * rate);
        close("potential", stored.potential, -190.0 * 9.8 * (std::f64::consts::FRAC_PI_3 + q).cos());
        close("cap", stored.cap_internal, volumes.0 * h(cap, b));
        close("rod", stored.rod_internal, volumes.1 * h(rod, b));
        close("pump line", book.pump_line, 1.2e-4 * h(pump, bp));
        close("damping", power(&book, "viscous_damping").total(), -1.3e4 * v * v);
        // The sign is rounded over 1 mm/s.
        close("Coulomb", power(&book, "coulomb_friction").total(), -160.0 * v.abs() * (v.abs() / 1e-3).tanh());
        let leak = -b * 1.4e-11 * (cap - rod) * (e(cap) - e(rod));
        close("internal leakage", power(&book, "internal_leakage").total(), leak);
        let leak = -b * (4.1e-12 * cap * e(cap) + 3.0e-12 * rod * e(rod));
        close("external leakage", power(&book, "external_leakage").total(), leak);
        close("pump", book.pump_power, bp * (pump / bp).exp_m1() * inputs.pump_flow);
        for name in ["inertia", "gravity", "oil_compressibility"] {
            let effect = power(&book, name);
            assert!(!effect.has_power && effect.total() == 0.0, "{effect:?}");
        }
    }
}

/// Effects that can only take energy.
const TAKING: &[&str] = &[
    "viscous_damping",
    "coulomb_friction",
    "stribeck_friction",
    "pressure_dependent_friction",
    "asymmetric_friction",
    "end_cushion",
    "hose_loss",
    "internal_leakage",
    "external_leakage",
    "orifice_flow",
    "valve_directional_gain",
    "valve_leakage",
    "open_centre_bypass",
    "relief_valve",
    "pump_leakage",
];

/// Friction, leakage, metering and bypass only ever take energy.
#[test]
fn losses_lose() {
    let mut random = Random(12);
    for model in common::machines() {
        let mut all = model.clone();
        for name in TAKING {
            let physics = Catalogue::built_in().find(name).unwrap();
            for site in all.free_sites(&physics) {
                all = common::with_typical(&all, &physics, site);
            }
        }
        let system = System::new(&all);
        for _ in 0..200 {
            let parameters = common::random_parameters(&all, &mut random);
            let mut state = common::random_state(&system, &mut random);
            for slot in state.iter_mut().skip(2 * system.layout().joints) {
                *slot = slot.abs();
            }
            let mut inputs = common::random_inputs(&all.machine, &mut random);
            inputs.tank_pressure = 0.0;
            let book = ledger(&system, &parameters, &state, &inputs);
            for effect in &book.effects {
                if TAKING.contains(&&*effect.effect) {
                    let size = effect.cap.abs() + effect.rod.abs() + effect.pump_line.abs();
                    // Between volumes of different bulk moduli an orifice is lossless in p, not in e; all else is exact.
                    let between = effect.acts_on == excavator_model::effects::ActsOn::Valve;
                    let slack = if between { 0.2 * size } else { 1e-12 * size };
                    assert!(effect.total() <= slack, "{} {effect:?}", all.machine.name);
                }
            }
        }
    }
}
