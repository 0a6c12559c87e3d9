//! What payload, contact, cushion and friction do to the motion.

use crate::common;
use crate::common::Random;
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};
use excavator_model::energy::ledger;
use excavator_model::equations::{Inputs, System};

fn with(base: &Model, effect: &str, cylinder: usize, values: &[f64]) -> Model {
    let mut model = base.with_effect(&Catalogue::built_in().find(effect).unwrap(), Site::Cylinder(cylinder)).unwrap();
    for (parameter, value) in model.effects.last_mut().unwrap().parameters.iter_mut().zip(values) {
        parameter.value = *value;
    }
    model
}

fn raised(base: &Model, changes: &[(&str, f64)]) -> Model {
    let mut model = base.clone();
    for (name, change) in changes {
        let index = model.parameter_names().iter().position(|candidate| candidate == name).unwrap();
        model.parameters_mut().nth(index).unwrap().value += change;
    }
    model
}

fn rates(model: &Model, state: &[f64], inputs: &Inputs<f64>) -> Vec<f64> {
    let system = System::new(model);
    let mut rates = vec![0.0; state.len()];
    system.rates(&mut system.workspace(), &model.parameter_values(), state, inputs, &mut rates);
    rates
}

/// A payload is the same machine with the inertias and gravity moments that a point mass adds, \[A\] Eq. 1.
#[test]
fn a_payload_is_inertia_and_weight_together() {
    let (m, r, l1) = (150.0, 1.7, 2.4);
    let (arm, both, load) = (built_in("zx30u-arm").unwrap(), built_in("zx30u").unwrap(), built_in("emps").unwrap());
    let second = [
        ("boom.inertia", m * (l1 * l1 + r * r)),
        ("boom.coupling_inertia", m * r * l1),
        ("arm.inertia", m * r * r),
        ("boom.gravity_moment", m * l1),
        ("arm.gravity_moment", m * r),
    ];
    let cases = [
        (with(&arm, "payload", 0, &[m, r]), raised(&arm, &[("arm.inertia", m * r * r), ("arm.gravity_moment", m * r)])),
        (
            with(&both, "payload", 0, &[m, r]),
            raised(&both, &[("boom.inertia", m * r * r), ("boom.gravity_moment", m * r)]),
        ),
        (with(&both, "payload", 1, &[m, r, l1]), raised(&both, &second)),
        (with(&load, "payload", 0, &[m, 0.0]), raised(&load, &[("load.mass", m)])),
    ];
    let mut random = Random(31);
    for (loaded, heavier) in &cases {
        for _ in 0..50 {
            let state = common::random_state(&System::new(loaded), &mut random);
            let inputs = common::random_inputs(&loaded.machine, &mut random);
            for (found, wanted) in rates(loaded, &state, &inputs).iter().zip(rates(heavier, &state, &inputs)) {
                assert!((found - wanted).abs() <= 1e-11 * wanted.abs() + 1e-9, "{found} {wanted}");
            }
        }
    }
}

/// On a slope a load pulls with its share of the weight.
#[test]
fn a_payload_on_a_slope_pulls() {
    let level = built_in("emps").unwrap();
    let found = rates(&with(&level, "payload", 0, &[50.0, 0.6]), &[0.1, 0.0], &Inputs::zero(1))[1];
    let mass = level.value_of("load.mass").unwrap() + 50.0;
    let offset = level.value_of("load.force_offset").unwrap();
    let wanted = -(50.0 * 9.8 * 0.6 + offset) / mass;
    assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
}

fn torque(model: &Model, state: &[f64], inputs: &Inputs<f64>) -> (f64, f64) {
    let system = System::new(model);
    let mut workspace = system.workspace();
    system.rates(&mut workspace, &model.parameter_values(), state, inputs, &mut vec![0.0; state.len()]);
    (workspace.rows.torque[0], workspace.rows.piston_force[0])
}

/// The torque of a contact, summed over time, is its size times its duration; it is there then and at no other time.
#[test]
fn a_contact_lasts_as_long_as_it_says() {
    let arm = built_in("zx30u-arm").unwrap();
    let touched = with(&arm, "external_contact", 0, &[3.0, 1.2, 400.0]);
    let state = common::at_rest(&System::new(&arm));
    let mut inputs = Inputs::zero(1);
    let mut impulse = 0.0;
    for step in 0..8000 {
        inputs.time = f64::from(step) * 1e-3;
        let added = torque(&touched, &state, &inputs).0 - torque(&arm, &state, &inputs).0;
        impulse += added * 1e-3;
        if inputs.time < 2.8 || inputs.time > 4.4 {
            assert!(added.abs() < 1e-2, "{added} N m at {} s", inputs.time);
        } else if (3.2..4.0).contains(&inputs.time) {
            assert!((added - 400.0).abs() < 1e-2, "{added} N m at {} s", inputs.time);
        }
    }
    assert!((impulse - 480.0).abs() < 0.1, "{impulse} N m s");
}

/// A load is carried as long as it says, and the energy that it has then comes with it.
#[test]
fn a_load_is_picked_up_and_put_down() {
    let arm = built_in("zx30u-arm").unwrap();
    let always = with(&arm, "payload", 0, &[80.0, 1.8]);
    let carried = with(&arm, "payload", 0, &[80.0, 1.8, 3.0, 1.2]);
    let system = System::new(&carried);
    let mut state = common::at_rest(&system);
    state[1] = 0.4;
    let mut inputs = Inputs::zero(1);
    let at = |model: &Model, inputs: &Inputs<f64>| rates(model, &state, inputs);
    for (time, same) in [(2.5, &arm), (3.5, &always), (4.5, &arm)] {
        inputs.time = time;
        for (found, wanted) in at(&carried, &inputs).iter().zip(at(same, &inputs)) {
            assert!((found - wanted).abs() <= 1e-7 * wanted.abs() + 1e-9, "{time} s: {found} {wanted}");
        }
    }
    let stored = |model: &Model| ledger(&System::new(model), &model.parameter_values(), &state, &inputs).stored();
    let wanted = stored(&always) - stored(&arm);
    // Held where it is while it is picked up, then while it is put down.
    for (first, sign) in [(2.5, 1.0), (3.7, -1.0)] {
        let brought: f64 = (0..10_000)
            .map(|step| {
                let mut inputs = Inputs::zero(1);
                inputs.time = first + f64::from(step) * 1e-4;
                let book = ledger(&system, &carried.parameter_values(), &state, &inputs);
                let effect = book.effects.iter().find(|effect| effect.effect == "payload").unwrap();
                assert!(effect.has_power);
                effect.mechanical * 1e-4
            })
            .sum();
        assert!((brought - sign * wanted).abs() < 1e-6 * wanted.abs(), "{brought} J, {wanted} J");
    }
}

/// A cushion brakes on the way in, by speed and depth, and nowhere else.
#[test]
fn a_cushion_brakes_on_the_way_in() {
    let arm = built_in("zx30u-arm").unwrap();
    let cushioned = with(&arm, "end_cushion", 0, &[0.05, 4e4]);
    let linkage = &arm.machine.cylinders[0].linkage;
    for (displacement, velocity, wanted) in [
        (0.275, 0.2, -4e4 * 0.5 * 0.2),
        (0.3, 0.2, -4e4 * 0.2),
        (-0.29, -0.1, 4e4 * 0.8 * 0.1),
        (0.275, -0.2, 0.0),
        (-0.29, 0.1, 0.0),
        (0.249, 0.2, 0.0),
        (0.0, -0.3, 0.0),
    ] {
        let mut state = common::at_rest(&System::new(&arm));
        state[0] = linkage.joint(displacement);
        state[1] = velocity / linkage.lever(state[0]);
        let inputs = Inputs::zero(1);
        let found = torque(&cushioned, &state, &inputs).1 - torque(&arm, &state, &inputs).1;
        assert!((found - wanted).abs() < 1e-6, "{displacement} m, {velocity} m/s: {found} N, not {wanted} N");
    }
}

/// Friction that differs by direction, and friction that pressure presses on: levels at 0.1 m/s.
#[test]
fn friction_has_the_levels_it_says() {
    let arm = built_in("zx30u-arm").unwrap();
    let linkage = &arm.machine.cylinders[0].linkage;
    let (asymmetric, pressed) =
        (with(&arm, "asymmetric_friction", 0, &[90.0]), with(&arm, "pressure_dependent_friction", 0, &[2e-4]));
    let mut state = common::at_rest(&System::new(&arm));
    (state[2], state[3]) = (1.5e6, 5e5);
    let half = 0.5_f64.tanh();
    for (velocity, of_direction, of_pressure) in [
        (0.1, -90.0, -400.0),
        (-0.1, 0.0, 400.0),
        (0.0, 0.0, 0.0),
        (5e-4, -90.0 * half, -400.0 * half),
        (-5e-4, 0.0, 400.0 * half),
    ] {
        state[1] = velocity / linkage.lever(state[0]);
        let inputs = Inputs::zero(1);
        let nominal = torque(&arm, &state, &inputs).1;
        for (model, wanted) in [(&asymmetric, of_direction), (&pressed, of_pressure)] {
            let found = torque(model, &state, &inputs).1 - nominal;
            assert!((found - wanted).abs() < 1e-9, "{velocity} m/s: {found} N, not {wanted} N");
        }
    }
    (state[2], state[3]) = (-9e4, -9e4);
    state[1] = 0.1 / linkage.lever(state[0]);
    let inputs = Inputs::zero(1);
    let vacuum = torque(&pressed, &state, &inputs).1 - torque(&arm, &state, &inputs).1;
    assert_eq!(vacuum, 0.0, "a chamber under vacuum presses no seal");
}

/// All friction of a piston turns round over the speed that is given, and over 1 mm/s where none is; nothing else does.
#[test]
fn friction_turns_round_as_it_is_told() {
    let arm = built_in("zx30u-arm").unwrap();
    let rubbed = with(&with(&arm, "asymmetric_friction", 0, &[90.0]), "pressure_dependent_friction", 0, &[2e-4]);
    let wider = with(&rubbed, "friction_reversal", 0, &[4e-3]);
    let mut state = common::at_rest(&System::new(&arm));
    (state[2], state[3]) = (1.5e6, 5e5);
    let viscous = arm.value_of("arm.viscous_damping").unwrap();
    let mut force = |model: &Model, velocity: f64| {
        state[1] = velocity / arm.machine.cylinders[0].linkage.lever(state[0]);
        torque(model, &state, &Inputs::zero(1)).1 + viscous * velocity
    };
    for velocity in [1e-4, -5e-4, 1e-3, -2e-2, 0.3] {
        let (narrow, wide) = (force(&rubbed, velocity), force(&wider, 4.0 * velocity));
        assert!((narrow - wide).abs() < 1e-9 * narrow.abs(), "{velocity} m/s: {narrow} N and {wide} N");
    }
}

/// The corner is as sharp as it is told: at minus one the law is `x / sqrt(1 + x²)`, at zero what it is without, at four a straight
/// line to a fifteenth.
#[test]
fn friction_turns_the_corner_that_it_is_told() {
    let arm = built_in("zx30u-arm").unwrap();
    let mut state = common::at_rest(&System::new(&arm));
    let viscous = arm.value_of("arm.viscous_damping").unwrap();
    let coulomb = arm.value_of("arm.coulomb_friction").unwrap();
    let mut share = |sharpness: Option<f64>, speed: f64| {
        let mut model = with(&arm, "friction_reversal", 0, &[2e-3]);
        if let Some(sharpness) = sharpness {
            model = with(&model, "friction_corner", 0, &[sharpness]);
        }
        let still = torque(&model, &state, &Inputs::zero(1)).1;
        state[1] = 2e-3 * speed / arm.machine.cylinders[0].linkage.lever(state[0]);
        let moving = torque(&model, &state, &Inputs::zero(1)).1;
        state[1] = 0.0;
        (still - moving - viscous * 2e-3 * speed) / coulomb
    };
    for speed in [-40.0, -3.0, -0.3, 1e-4, 0.5, 0.9, 2.0, 500.0_f64] {
        let near = |found: f64, wanted: f64, off: f64| {
            assert!((found - wanted).abs() < off, "at {speed}: {found}, should be {wanted}");
        };
        near(share(Some(0.0), speed), share(None, speed), 1e-9);
        near(share(Some(1e-7), speed), share(Some(-1e-7), speed), 1e-4);
        near(share(Some(-1.0), speed), speed / speed.hypot(1.0), 1e-7);
        near(share(Some(4.0), speed), (1.03 * speed).clamp(-1.0, 1.0), 1.0 / 15.0);
    }
}
