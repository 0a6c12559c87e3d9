//! Boom, arm and bucket at once: a chain of three links is identified from a noisy recording.

use excavator_identification::regression::{WeakFormSettings, weak_form};
use excavator_model::document::built_in;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Openings in m² and frequencies in Hz of two sines for each of boom, arm and bucket.
const SINES: [[(f64, f64); 2]; 3] =
    [[(6e-5, 0.31), (3e-5, 0.83)], [(6e-5, 0.43), (3e-5, 1.07)], [(6e-5, 0.59), (3e-5, 1.31)]];

#[test]
fn a_chain_of_three_links_is_identified() {
    let mut machine = built_in("zx30u-bucket").unwrap();
    for (number, parameter) in machine.parameters_mut().filter(|parameter| !parameter.known).enumerate() {
        parameter.value *= 1.0 + 0.1 * (1.7 * number as f64 + 0.4).sin();
    }
    let time: Vec<f64> = (0..20_000).map(|index| f64::from(index) * 2e-3).collect();
    let mut recording = Recording::unmeasured("three joints", time, &["boom", "arm", "bucket"]);
    recording.tank_pressure.fill(3e5);
    recording.pump_flow.fill(7.6e-4);
    for (cylinder, sines) in recording.cylinders.iter_mut().zip(SINES) {
        let wave = |t: &f64| sines.iter().map(|(size, rate)| size * (std::f64::consts::TAU * rate * t).sin()).sum();
        cylinder.orifice_area = recording.time.iter().map(wave).collect();
    }
    let mut recording =
        simulate_from_rest(&machine, &recording, &[0.05, 0.05, 0.0], Tolerances::default().scaled(0.05)).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut add = |signal: &mut Vec<f64>, level: f64| {
        for value in signal {
            let normal: f64 = StandardNormal.sample(&mut random);
            *value += level * normal;
        }
    };
    for cylinder in &mut recording.cylinders {
        let range = cylinder.displacement.iter().fold((9.0_f64, -9.0_f64), |(l, h), &s| (l.min(s), h.max(s)));
        println!("{} moves from {:+.3} m to {:+.3} m", cylinder.name, range.0, range.1);
        cylinder.velocity.fill(f64::NAN);
        cylinder.joint_angle.fill(f64::NAN);
        add(&mut cylinder.displacement, 2e-5);
        add(&mut cylinder.cap_pressure, 2e3);
        add(&mut cylinder.rod_pressure, 2e3);
        add(&mut cylinder.orifice_area, 1e-7);
    }
    add(&mut recording.pump_pressure, 2e3);

    let found = weak_form(&built_in("zx30u-bucket").unwrap(), &[&recording], &WeakFormSettings::default()).unwrap();
    for (name, share) in [
        ("boom.inertia", 0.01),
        ("arm.inertia", 0.01),
        ("bucket.inertia", 0.02),
        ("arm.coupling_moment", 0.04),
        ("bucket.coupling_moment", 0.04),
        ("boom.gravity_moment", 0.01),
        ("arm.gravity_moment", 0.01),
        ("bucket.gravity_moment", 0.02),
        ("boom.viscous_damping", 0.02),
        ("arm.viscous_damping", 0.02),
        ("bucket.viscous_damping", 0.02),
    ] {
        let (value, truth) = (found.model.value_of(name).unwrap(), machine.value_of(name).unwrap());
        let off = value / truth - 1.0;
        println!("{name:24} {value:10.2} for {truth:10.2}: {:+.2} %", 100.0 * off);
        assert!(off.abs() < share, "{name}");
    }
}
