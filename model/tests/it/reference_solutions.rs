//! Solutions that are known otherwise, each with its own tolerance: in closed form, or from `diffsol`.

use crate::common;
use crate::common::references::{Motion, STATES, arm, distance, stored, two_joints};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use excavator_model::simulation::{InputSignals, Integrator, Tolerances};

/// States at all samples.
fn trajectory(model: &Model, recording: &Recording, start: &[f64], tolerances: Tolerances) -> Vec<Vec<f64>> {
    let signals = InputSignals::from_recording(model, recording).unwrap();
    let system = System::new(model);
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &[], tolerances);
    let mut state = start.to_vec();
    let mut states = vec![state.clone()];
    for index in 0..signals.len() - 1 {
        integrator.advance(&signals, index, &mut state, None).unwrap();
        states.push(state.clone());
    }
    states
}

/// The EMPS drive without Coulomb friction under a force that rises as a ramp: `M dv/dt + Fd v = k t` has
/// `v = k/Fd (t - T (1 - exp(-t/T)))`, `T = M/Fd`. The input is a straight line, so interpolation adds no error.
#[test]
fn mass_and_damper_under_a_ramp_of_force() {
    let mut model = built_in("emps").unwrap();
    model.effects.retain(|effect| ["inertia", "viscous_damping"].contains(&effect.name()));
    model.set_parameter_values(&[80.0, 400.0]);
    let (mass, damping, slope) = (80.0_f64, 400.0, 300.0);
    let recording = common::driven(&model, 1.0, 1e-3, |_, _| 0.0, |t| slope * t);
    let time_constant = mass / damping;
    let velocity = |t: f64| slope / damping * (t - time_constant * (1.0 - (-t / time_constant).exp()));
    let position = |t: f64| {
        let settled = time_constant * t - time_constant.powi(2) * (1.0 - (-t / time_constant).exp());
        slope / damping * (t * t / 2.0 - settled)
    };
    for (tolerances, position_error, velocity_error) in
        [(Tolerances::default(), 1e-6, 1e-6), (Tolerances::default().scaled(1e-6), 1e-10, 1e-10)]
    {
        let states = trajectory(&model, &recording, &[0.0, 0.0], tolerances);
        let worst = |state: usize, exact: &dyn Fn(f64) -> f64| {
            let errors = states.iter().zip(&recording.time).map(|(found, &t)| (found[state] - exact(t)).abs());
            errors.fold(0.0, f64::max)
        };
        let (in_position, in_velocity) = (worst(0, &position), worst(1, &velocity));
        println!("mass and damper: {in_position:.1e} m, {in_velocity:.1e} m/s");
        assert!(in_position < position_error && in_velocity < velocity_error, "{in_position} {in_velocity}");
    }
}

/// A piston held in place, its valve closed: the difference of the pressures decays through the internal leakage, and
/// both leak to the outside. With the volumes constant the two pressures obey a linear system with constant
/// coefficients, whose solution is written with its two eigenvalues.
#[test]
fn closed_valve_leaks_as_its_eigenvalues_say() {
    let mut model = built_in("zx30u-arm").unwrap();
    for name in ["gravity", "coulomb_friction", "viscous_damping", "end_stop", "open_centre_bypass"] {
        model.effects.retain(|effect| effect.name() != name);
    }
    let (internal, external_cap, external_rod) = (2e-10, 3e-11, 5e-11);
    for (name, value) in [
        // A hundred million tons: pressures move the joint by nothing.
        ("arm.inertia", 1e11),
        ("arm.internal_leakage", internal),
        ("arm.external_leakage_cap", external_cap),
        ("arm.external_leakage_rod", external_rod),
    ] {
        let index = model.parameter_names().iter().position(|candidate| candidate == name).unwrap();
        model.parameters_mut().nth(index).unwrap().value = value;
    }
    let cylinder = &model.machine.cylinders[0];
    let chambers = cylinder.chambers.unwrap();
    let modulus = 9.6e8;
    let (cap, rod) = (chambers.cap_volume(0.6, 0.0) / modulus, chambers.rod_volume(0.6, 0.0) / modulus);
    // d/dt (p+, p-) = matrix (p+, p-)
    let matrix: [[f64; 2]; 2] =
        [[-(internal + external_cap) / cap, internal / cap], [internal / rod, -(internal + external_rod) / rod]];
    let (mean, half) = ((matrix[0][0] + matrix[1][1]) / 2.0, (matrix[0][0] - matrix[1][1]) / 2.0);
    let root = (half * half + matrix[0][1] * matrix[1][0]).sqrt();
    let start = [5e6, 1e6];
    // exp(A t) = exp(mean t) (cosh(root t) + (A - mean) sinh(root t) / root), in exponentials that do not overflow.
    let exact = |t: f64| {
        let (slow, fast) = (((mean + root) * t).exp(), ((mean - root) * t).exp());
        let (even, odd) = ((slow + fast) / 2.0, (slow - fast) / (2.0 * root));
        let row = |row: usize| {
            let product = matrix[row][0] * start[0] + matrix[row][1] * start[1];
            even * start[row] + odd * (product - mean * start[row])
        };
        [row(0), row(1)]
    };
    let recording = common::driven(&model, 20.0, 1e-2, |_, _| 0.0, |_| 0.0);
    let state = [cylinder.linkage.joint(0.0), 0.0, start[0], start[1], 0.0];
    let mut model = model.clone();
    // The pump line has no outlet; without flow it rests.
    if let excavator_model::machine::Supply::PumpLine(line) = &mut model.machine.supply {
        line.flow = 0.0;
    }
    for (tolerances, allowed) in [(Tolerances::default(), 300.0), (Tolerances::default().scaled(1e-5), 1e-2)] {
        let states = trajectory(&model, &recording, &state, tolerances);
        let mut worst = 0.0_f64;
        for (found, &t) in states.iter().zip(&recording.time) {
            let exact = exact(t);
            worst = worst.max((found[2] - exact[0]).abs()).max((found[3] - exact[1]).abs());
        }
        println!("closed valve leaking for 20 s from 5 MPa: {worst:.1e} Pa");
        assert!(worst < allowed, "{worst} Pa");
        let last = exact(20.0);
        assert!(last[0] < 0.3 * start[0], "the test sees a decay: {last:?}");
    }
}

/// A chamber that fills through leakage from a constant supply: `p = ps (1 - exp(-t/T))`, \[B\] Eq. 12.
#[test]
fn pressure_builds_up_with_its_time_constant() {
    let mut model = common::closed_centre();
    model.effects.retain(|effect| ["inertia", "oil_compressibility"].contains(&effect.name()));
    let mut model =
        model.with_effect(&Catalogue::built_in().find("valve_leakage").unwrap(), Site::Cylinder(0)).unwrap();
    let gain = 4e-11;
    model.set_parameter_values(&[1e11, 9.6e8, gain, 0.0, 0.0, 0.0]);
    let cylinder = &model.machine.cylinders[0];
    let compliance = cylinder.chambers.unwrap().cap_volume(0.6, 0.0) / 9.6e8;
    let recording = common::driven(&model, 0.5, 1e-3, |_, _| 0.0, |_| 0.0);
    let states = trajectory(&model, &recording, &[cylinder.linkage.joint(0.0), 0.0, 0.0, 0.0], Tolerances::default());
    let mut worst = 0.0_f64;
    for (found, &t) in states.iter().zip(&recording.time) {
        worst = worst.max((found[2] - 5e6 * (1.0 - (-t * gain / compliance).exp())).abs());
    }
    println!("pressure build-up to 5 MPa: {worst:.1e} Pa");
    assert!(worst < 50.0, "{worst} Pa");
    assert!(states.last().unwrap()[2] > 4.9e6);
}

/// How far the default tolerance may be from the truth at any one sample, in units of sensor noise. It is reached for
/// some milliseconds where a chamber leaves cavitation while the valve changes direction, two corners inside one step,
/// which no error estimate of a smooth method sees.
const DEFAULT_LARGEST: f64 = 0.5;

/// The same for the root of the mean square over the trajectory.
const DEFAULT_MEAN: f64 = 0.05;

/// Root of the mean squared distance of one state between two trajectories.
fn mean_distance(a: &[Vec<f64>], b: &[Vec<f64>], state: usize) -> f64 {
    assert_eq!(a.len(), b.len());
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a[state] - b[state]).powi(2)).sum();
    (squares / a.len() as f64).sqrt()
}

/// Checks the default tolerance against the solution of diffsol, and one a million times tighter, which must come within `least` of the
/// sensors' noise.
fn moves_as_diffsol_says(motion: &Motion, least: f64) {
    let reference = stored(motion);
    let follow = |tolerances| trajectory(&motion.model, &motion.recording, &motion.start, tolerances);
    let (ours, tight) = (follow(Tolerances::default()), follow(Tolerances::default().scaled(1e-6)));
    for (state, kind) in motion.kinds().into_iter().enumerate() {
        let (unit, noise) = STATES[kind];
        let (default, tight) = (distance(&ours, &reference, state), distance(&tight, &reference, state));
        let mean = mean_distance(&ours, &reference, state);
        println!(
            "{}, state {state}: default {default:.1e} {unit}, root mean square {mean:.1e}, tight {tight:.1e}",
            motion.name
        );
        assert!(default < DEFAULT_LARGEST * noise, "default tolerance, state {state}: {default} {unit}");
        assert!(mean < DEFAULT_MEAN * noise, "default tolerance, state {state}: {mean} {unit}");
        assert!(tight < least * noise, "tight tolerance, state {state}: {tight} {unit}");
    }
    let travel = reference.iter().map(|state| motion.model.machine.cylinders[0].linkage.displacement(state[0]));
    let (low, high) = travel.fold((f64::MAX, f64::MIN), |(low, high), s| (low.min(s), high.max(s)));
    assert!(high - low > 0.05, "the arm moves: {low} to {high} m");
}

#[test]
fn the_arm_moves_as_diffsol_says() {
    moves_as_diffsol_says(&arm(), 1e-4);
}

/// The same for the two joints that pull on each other: with more corners, less near.
#[test]
fn two_joints_move_as_diffsol_says() {
    moves_as_diffsol_says(&two_joints(), 3e-4);
}

/// Errors follow tolerances: ten thousand times tighter, at least a thousand times nearer.
#[test]
fn errors_shrink_with_the_tolerance() {
    let motion = arm();
    // Two seconds: later, corners inside one step hide the order.
    let samples = 2001;
    let reference = stored(&motion);
    let error = |factor: f64| {
        let states = trajectory(&motion.model, &motion.recording, &motion.start, Tolerances::default().scaled(factor));
        let relative =
            |(state, kind): (usize, usize)| distance(&states[..samples], &reference[..samples], state) / STATES[kind].1;
        motion.kinds().into_iter().enumerate().map(relative).fold(0.0, f64::max)
    };
    let errors: Vec<f64> = [1.0, 1e-2, 1e-4, 1e-6].into_iter().map(error).collect();
    println!("errors in units of sensor noise, tolerances 1, 1e-2, 1e-4, 1e-6: {errors:?}");
    for pair in errors.windows(2) {
        assert!(pair[1] < 0.5 * pair[0], "{errors:?}");
    }
    assert!(errors[3] < errors[1] / 1000.0, "{errors:?}");
}
