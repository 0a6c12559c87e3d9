//! Chains of links: the closed form of \[A\] is the case of two, and three links move as their masses say.

use crate::common;
use crate::common::Random;
use excavator_model::Model;
use excavator_model::document::{built_in, parse, to_text};
use excavator_model::effects::{Catalogue, Site};
use excavator_model::equations::System;
use excavator_model::machine::Mechanism;

/// Boom and arm as a chain, with the same physics: J1, J2, and R12 as length times first moment.
fn as_chain(two: &Model, length: f64) -> Model {
    let mut chain = two.clone();
    chain.machine.mechanism = Mechanism::PlanarChain { link_lengths: vec![length], swing: None };
    chain.effects.clear();
    for effect in &two.effects {
        chain = chain.with_effect(&effect.physics, effect.site).unwrap();
        let parameters = &mut chain.effects.last_mut().unwrap().parameters;
        for parameter in parameters {
            if let Some(same) = effect.parameters.iter().find(|other| other.card.name == parameter.card.name) {
                parameter.value = same.value;
            }
        }
    }
    let coupling = two.value_of("boom.coupling_inertia").unwrap() / length;
    let index = chain.parameter_names().iter().position(|name| name == "arm.coupling_moment").unwrap();
    chain.parameters_mut().nth(index).unwrap().value = coupling;
    chain
}

fn assert_same_rates(one: &Model, other: &Model, random: &mut Random) {
    let (one_system, other_system) = (System::new(one), System::new(other));
    for _ in 0..200 {
        let state = common::random_state(&one_system, random);
        let inputs = common::random_inputs(&one.machine, random);
        let rates = |system: &System<'_>, model: &Model| {
            let mut rates = vec![0.0; state.len()];
            system.rates(&mut system.workspace(), &model.parameter_values(), &state, &inputs, &mut rates);
            rates
        };
        let pairs = rates(&one_system, one).into_iter().zip(rates(&other_system, other));
        for (index, (found, wanted)) in pairs.enumerate() {
            assert!((found - wanted).abs() <= 1e-11 * (wanted.abs() + 1.0), "{index}: {found} {wanted}");
        }
    }
}

#[test]
fn two_links_of_a_chain_are_the_closed_form_of_the_paper() {
    let mut random = Random(51);
    for _ in 0..10 {
        let mut two = built_in("zx30u").unwrap();
        let values = common::random_parameters(&two, &mut random);
        two.set_parameter_values(&values);
        let length = random.between(1.5, 3.5);
        let chain = as_chain(&two, length);
        assert_same_rates(&chain, &two, &mut random);
        // A payload on either link too.
        for link in 0..2 {
            let (mass, distance) = (random.between(10.0, 200.0), random.between(0.5, 2.0));
            let loaded = |model: &Model| {
                let mut model =
                    model.with_effect(&Catalogue::built_in().find("payload").unwrap(), Site::Cylinder(link)).unwrap();
                // Its times are those of a load that is there always.
                let own = model.effects.last_mut().unwrap().parameters.iter_mut().filter(|parameter| !parameter.known);
                for (parameter, value) in own.zip([mass, distance, length]) {
                    parameter.value = value;
                }
                model
            };
            assert_same_rates(&loaded(&chain), &loaded(&two), &mut random);
        }
    }
}

/// Mass, length to the next joint, distance of the centre of gravity, own moment of inertia: as `zx30u-bucket.toml` says.
const LINKS: [[f64; 4]; 3] = [[190.0, 2.5, 1.1, 95.0], [130.0, 1.3, 0.7, 20.0], [60.0, 0.0, 0.35, 2.65]];

/// Kinetic energy of the three links from their masses, centre by centre, and their potential energy.
fn energies(angles: [f64; 3], rates: [f64; 3]) -> (f64, f64) {
    let (mut angle, mut rate) = (0.0, 0.0);
    let (mut joint_velocity, mut joint_height) = ([0.0_f64, 0.0], 0.0);
    let (mut kinetic, mut potential) = (0.0, 0.0);
    for (index, [mass, length, centre, own]) in LINKS.into_iter().enumerate() {
        angle += angles[index];
        rate += rates[index];
        // Straight down at angle zero: along (sin, -cos), which turns towards (cos, sin).
        let velocity = |reach: f64| {
            [joint_velocity[0] + reach * rate * angle.cos(), joint_velocity[1] + reach * rate * angle.sin()]
        };
        let centre_velocity = velocity(centre);
        kinetic += 0.5 * mass * (centre_velocity[0].powi(2) + centre_velocity[1].powi(2)) + 0.5 * own * rate * rate;
        potential += mass * 9.8 * (joint_height - centre * angle.cos());
        joint_velocity = velocity(length);
        joint_height -= length * angle.cos();
    }
    (kinetic, potential)
}

/// Lagrange's equations of those energies, by differences: mass matrix times accelerations plus velocity terms and weight is
/// what the recursion has.
#[test]
fn three_links_move_as_their_masses_say() {
    let mut model = built_in("zx30u-bucket").unwrap();
    model.effects.retain(|effect| ["inertia", "gravity"].contains(&effect.name()));
    let system = System::new(&model);
    let mut random = Random(52);
    for _ in 0..50 {
        let angles: [f64; 3] = std::array::from_fn(|_| random.between(-3.0, 3.0));
        let rates: [f64; 3] = std::array::from_fn(|_| random.between(-1.0, 1.0));
        let mut state = vec![0.0; system.layout().len];
        state[..3].copy_from_slice(&angles);
        state[3..6].copy_from_slice(&rates);
        let mut workspace = system.workspace();
        let inputs = excavator_model::equations::Inputs::zero(3);
        let mut derivative = vec![0.0; state.len()];
        system.rates(&mut workspace, &model.parameter_values(), &state, &inputs, &mut derivative);
        let unit =
            |index: usize, size: f64| -> [f64; 3] { std::array::from_fn(|k| if k == index { size } else { 0.0 }) };
        let plus = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| a[k] + b[k]) };
        // The kinetic energy is a quadratic form in the rates: its entries come out of unit rates exactly.
        let mass = |angles: [f64; 3], row: usize, column: usize| {
            let both = energies(angles, plus(unit(row, 1.0), unit(column, 1.0))).0;
            both - energies(angles, unit(row, 1.0)).0 - energies(angles, unit(column, 1.0)).0
        };
        let step = 1e-5;
        for row in 0..3 {
            for column in 0..3 {
                let (found, wanted) = (workspace.rows.mass_at(row, column), mass(angles, row, column));
                assert!((found - wanted).abs() < 1e-9 * 2000.0, "{row} {column}: {found} {wanted}");
            }
            // -(d/dt of momentum at constant rates) + d(T - V)/dq.
            let momentum =
                |angles: [f64; 3]| (0..3).map(|column| mass(angles, row, column) * rates[column]).sum::<f64>();
            let along: [f64; 3] = std::array::from_fn(|k| rates[k] * step);
            let back: [f64; 3] = std::array::from_fn(|k| -rates[k] * step);
            let change = (momentum(plus(angles, along)) - momentum(plus(angles, back))) / (2.0 * step);
            let lagrangian = |angles: [f64; 3]| {
                let (kinetic, potential) = energies(angles, rates);
                kinetic - potential
            };
            let slope =
                (lagrangian(plus(angles, unit(row, step))) - lagrangian(plus(angles, unit(row, -step)))) / (2.0 * step);
            let (found, wanted) = (workspace.rows.torque[row], slope - change);
            assert!((found - wanted).abs() < 1e-6 * 1e4, "torque {row}: {found} {wanted}");
        }
    }
}

#[test]
fn a_chain_is_written_and_read_back() {
    let model = built_in("zx30u-bucket").unwrap();
    let names = model.parameter_names();
    for name in ["boom.inertia", "arm.inertia", "arm.coupling_moment", "bucket.inertia", "bucket.coupling_moment"] {
        assert!(names.iter().any(|candidate| candidate == name), "{name}");
    }
    let again = parse("again", &to_text(&model).unwrap(), &Catalogue::built_in()).unwrap();
    assert_eq!(again.machine, model.machine);
    assert_eq!(again.parameter_values(), model.parameter_values());
    // One length too few: the third cylinder has no joint.
    let text = to_text(&model).unwrap();
    let mut short: toml::Table = text.parse().unwrap();
    let lengths = &mut short["machine"]["mechanism"]["link_lengths"];
    lengths.as_array_mut().unwrap().pop();
    let error = parse("short", &short.to_string(), &Catalogue::built_in()).unwrap_err().to_string();
    assert!(error.contains("the mechanism has 2 joint(s), but there are 3 cylinder(s)"), "{error}");
}
