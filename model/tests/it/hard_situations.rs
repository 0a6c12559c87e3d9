//! Situations in which integrators stall: end stops, closed valves, no pressure drop, sticking friction, cavitation.

use crate::common;
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::equations::{System, smooth};
use excavator_model::recording::Recording;
use excavator_model::scalar::{derivative, variable};
use excavator_model::simulation::{
    InputSignals, Integrator, RunError, SimulationError, Tolerances, simulate, simulate_from_rest,
};

/// States at all samples and the number of steps that they took.
fn run(model: &Model, recording: &Recording, start: &[f64]) -> (Vec<Vec<f64>>, usize) {
    let signals = InputSignals::from_recording(model, recording).unwrap();
    let system = System::new(model);
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &[], Tolerances::default());
    let mut state = start.to_vec();
    let mut states = vec![state.clone()];
    for index in 0..signals.len() - 1 {
        integrator.advance(&signals, index, &mut state, None).unwrap();
        assert!(state.iter().all(|value| value.is_finite()), "{state:?} at sample {index}");
        states.push(state.clone());
    }
    (states, integrator.steps.0 + integrator.steps.1)
}

fn displacements(model: &Model, states: &[Vec<f64>], joint: usize) -> Vec<f64> {
    states.iter().map(|state| model.machine.cylinders[joint].linkage.displacement(state[joint])).collect()
}

/// Full opening each way: the piston stops within a millimetre of the end and stays there. The boom that falls into its
/// end brings 100 J, which the contact of 5e7 N/m takes up over 1.6 mm before it pushes back.
#[test]
fn pistons_stop_at_their_ends() {
    for name in ["zx30u-arm", "zx30u"] {
        let model = built_in(name).unwrap();
        for opening in [1.1e-4, -1.1e-4] {
            for driven in 0..model.machine.cylinders.len() {
                let area = |number: usize, _: f64| if number == driven { opening } else { 0.0 };
                let recording = common::driven(&model, 12.0, 1e-3, area, |_| 0.0);
                let (states, steps) = run(&model, &recording, &common::at_rest(&System::new(&model)));
                let path = displacements(&model, &states, driven);
                let half = model.machine.cylinders[driven].stroke / 2.0;
                let end = half * opening.signum();
                let beyond = path.iter().map(|s| s.abs() - half).fold(f64::MIN, f64::max);
                let settled = path[path.len() - 2000..].iter().map(|s| (s - end).abs()).fold(0.0, f64::max);
                println!(
                    "{name} {driven} {opening:e}: {:.2} mm beyond the end, {:.2} mm from it at rest, {steps} steps",
                    beyond * 1e3,
                    settled * 1e3
                );
                let falling_boom = name == "zx30u" && driven == 0 && opening < 0.0;
                let allowed = if falling_boom { 2e-3 } else { 1e-3 };
                assert!(beyond > 0.0 && beyond < allowed, "{name} {driven} {opening}: {beyond} m beyond the end");
                assert!(settled < 1e-3, "{name} {driven} {opening}: {settled} m from the end");
                assert!(steps < 2 * states.len(), "{name} {driven} {opening}: {steps} steps for {}", states.len());
            }
        }
    }
}

/// A held command that jumps to full opening and back, at 100 Hz.
#[test]
fn jumps_of_a_held_command_do_not_stall() {
    let model = built_in("zx30u").unwrap();
    let mut recording = common::driven(&model, 6.0, 1e-2, |_, _| f64::NAN, |_| 0.0);
    let time = recording.time.clone();
    for (number, cylinder) in recording.cylinders.iter_mut().enumerate() {
        cylinder.orifice_command =
            time.iter().map(|t| [1.1e-4, 0.0, -1.1e-4, 0.0][((t * 2.0 + 0.5 * number as f64) as usize) % 4]).collect();
    }
    let (states, steps) = run(&model, &recording, &common::at_rest(&System::new(&model)));
    println!("jumps: {steps} steps for {} samples", states.len());
    assert!(steps < 40 * states.len(), "{steps}");
}

/// Closed valve for five seconds from a start where every pressure is zero and nothing moves: no pressure drop anywhere.
/// The load sinks until the oil carries it, and then just as fast as the oil leaks past and out.
#[test]
fn a_closed_valve_holds_but_for_leakage() {
    for name in ["zx30u-arm", "zx30u"] {
        let model = built_in(name).unwrap();
        let system = System::new(&model);
        let layout = system.layout();
        let recording = common::driven(&model, 5.0, 1e-3, |_, _| 0.0, |_| 0.0);
        let mut start = common::at_rest(&system);
        start[2 * layout.joints..].fill(0.0);
        let (states, steps) = run(&model, &recording, &start);
        for (joint, cylinder) in model.machine.cylinders.iter().enumerate() {
            let path = displacements(&model, &states, joint);
            let (cap, rod) = (layout.cap_pressure(joint).unwrap(), layout.rod_pressure(joint).unwrap());
            // The chamber under pressure is the one whose oil sets the speed.
            let loaded_cap = states[4500][cap] > states[4500][rod];
            let value = |what: &str| model.value_of(&format!("{}.{what}", cylinder.name)).unwrap();
            let chambers = cylinder.chambers.unwrap();
            let leaked: f64 = states[4000..5000]
                .iter()
                .map(|state| {
                    let across = value("internal_leakage") * (state[cap] - state[rod]);
                    if loaded_cap {
                        (across + value("external_leakage_cap") * state[cap]) / -chambers.cap_area * 1e-3
                    } else {
                        (value("external_leakage_rod") * state[rod] - across) / chambers.rod_area * 1e-3
                    }
                })
                .sum();
            let crept = path[5000] - path[4000];
            println!(
                "{name} {joint}: sinks {:.2} mm, creeps {:.3} mm/s, leakage {:.3} mm/s",
                (path[4000] - path[0]) * 1e3,
                crept * 1e3,
                leaked * 1e3
            );
            assert!((crept - leaked).abs() < 0.05 * leaked.abs() + 1e-5, "{name} {joint}: {crept} {leaked}");
        }
        assert!(steps < 2 * states.len(), "{steps}");
    }
}

/// Under less force than friction the EMPS drive creeps by less than a millimetre in a second; under more it slides.
#[test]
fn friction_sticks() {
    let mut model = built_in("emps").unwrap();
    model.set_parameter_values(&[80.0, 150.0, 15.0, 0.0]);
    let travel = |force: f64| {
        let recording = common::driven(&model, 1.0, 1e-3, |_, _| 0.0, |_| force);
        let (states, _) = run(&model, &recording, &[0.0, 0.0]);
        states.last().unwrap()[0]
    };
    for force in [0.0, 8.0, -11.0] {
        assert!(travel(force).abs() < 1e-3, "{force} N: {} m", travel(force));
    }
    assert!(travel(20.0) > 0.01, "{}", travel(20.0));
}

/// A heavy arm lowered fast empties a chamber: its pressure rests at the floor, 2 kPa below the vapour pressure at most,
/// and not lower for longer.
#[test]
fn pressure_does_not_fall_below_vapour() {
    let mut model = built_in("zx30u-arm").unwrap();
    let weight = model.parameter_names().iter().position(|name| name == "arm.gravity_moment").unwrap();
    model.parameters_mut().nth(weight).unwrap().value = 600.0;
    let floor = model.value_of("arm.vapour_pressure").unwrap();
    let mut cavitated = 0;
    for opening in [1e-4, -1e-4] {
        let recording = common::driven(&model, 4.0, 1e-3, |_, t| opening * (4.0 * t).sin(), |_| 0.0);
        let (states, _) = run(&model, &recording, &common::at_rest(&System::new(&model)));
        for pressure in states.iter().flat_map(|state| &state[2..4]) {
            assert!(*pressure > floor - 1e4, "{pressure} Pa");
            cavitated += usize::from(*pressure < floor);
        }
    }
    assert!(cavitated > 100, "the test never reached the floor: {cavitated} samples");
}

/// The sign of the velocity has finite derivatives at any speed, and is the hyperbolic tangent.
#[test]
fn the_rounded_sign_is_smooth_at_any_speed() {
    for speed in [0.0_f64, 1e-9, 3e-4, 1e-3, 5e-3, 0.019, 0.021, 0.5, 30.0] {
        for velocity in [speed, -speed] {
            let sign = smooth::rounded_sign(variable(velocity, 0) / smooth::SLIP_SPEED);
            let exact = (velocity / smooth::SLIP_SPEED).tanh();
            let slope = (1.0 - exact * exact) / smooth::SLIP_SPEED;
            assert!((sign.re - exact).abs() < 1e-15, "{velocity}: {} {exact}", sign.re);
            assert!((derivative(&sign, 0) - slope).abs() < 1e-12 / smooth::SLIP_SPEED, "{velocity}");
        }
    }
}

/// Every effect, typical and five times as strong: into both ends at full opening, held commands that jump at 100 Hz.
#[test]
fn no_effect_stalls() {
    let base = built_in("zx30u-arm").unwrap();
    let mut worst = (0.0, String::new());
    for physics in &common::catalogue() {
        for site in base.free_sites(physics) {
            for strength in [1.0, 5.0] {
                let mut model = common::with_typical(&base, physics, site);
                for parameter in &mut model.effects.last_mut().unwrap().parameters {
                    let card = &parameter.card;
                    parameter.value = (strength * parameter.value).clamp(card.minimum, card.maximum);
                }
                let start = common::at_rest(&System::new(&model));
                let steadily = |_: usize, t: f64| if t < 3.0 { 1.1e-4 } else { -1.1e-4 };
                let into_both_ends = common::driven(&model, 8.0, 1e-3, steadily, |_| 0.0);
                let mut jumping = common::driven(&model, 3.0, 1e-2, |_, _| f64::NAN, |_| 0.0);
                jumping.cylinders[0].orifice_command =
                    jumping.time.iter().map(|t| [1.1e-4, 0.0, -1.1e-4, 0.0][((t * 2.0) as usize) % 4]).collect();
                let label = common::label(&model, model.effects.len() - 1);
                for (recording, most) in [(&into_both_ends, 2), (&jumping, 60)] {
                    let (states, steps) = run(&model, recording, &start);
                    assert!(steps < most * states.len(), "{strength} x {label}: {steps} steps for {}", states.len());
                    let per_sample = steps as f64 / (most * states.len()) as f64;
                    if per_sample > worst.0 {
                        worst = (per_sample, format!("{strength} x {label}"));
                    }
                }
            }
        }
    }
    println!("nearest to stalling: {} with {:.2} of the steps allowed", worst.1, worst.0);
}

/// What each effect costs: time of the same simulation with it, relative to without. A measurement, not a test: run it
/// alone on a quiet machine with `--ignored --nocapture`.
#[test]
#[ignore = "measures time"]
fn cost_of_each_effect() {
    let base = built_in("zx30u-arm").unwrap();
    let time = |model: &Model| {
        let recording = common::tour(model);
        let start = common::at_rest(&System::new(model));
        let clock = std::time::Instant::now();
        let (states, steps) = run(model, &recording, &start);
        (clock.elapsed().as_secs_f64(), steps as f64 / states.len() as f64)
    };
    for physics in &common::catalogue() {
        for site in base.free_sites(physics) {
            let model = common::with_typical(&base, physics, site);
            // In turns, so that what else the machine does meets both alike; the least of each is the least disturbed.
            let (mut nominal, mut with, mut steps) = (f64::INFINITY, f64::INFINITY, 0.0);
            for _ in 0..7 {
                nominal = time(&base).0.min(nominal);
                let (seconds, per_sample) = time(&model);
                (with, steps) = (with.min(seconds), per_sample);
            }
            let label = common::label(&model, model.effects.len() - 1);
            println!("{:.2} x {:.1} ms for 20 s, {steps:.2} steps per sample: {label}", with / nominal, nominal * 1e3);
        }
    }
}

/// A model that cannot be simulated says where and why in one line; it does not hang.
#[test]
fn nonsense_ends_with_a_reason() {
    let mut model = built_in("zx30u-arm").unwrap();
    let inertia = model.parameter_names().iter().position(|name| name == "arm.inertia").unwrap();
    model.parameters_mut().nth(inertia).unwrap().value = f64::NAN;
    let mut recording = common::driven(&model, 0.1, 1e-3, |_, _| 5e-5, |_| 0.0);
    recording.cylinders[0].displacement.fill(0.0);
    let error = simulate(&model, &recording).unwrap_err();
    assert!(matches!(error, RunError::Simulation(SimulationError::StepTooSmall { .. })), "{error:?}");
    assert!(!error.to_string().contains('\n'));
}

/// A simulation that would take hours ends with a reason too.
#[test]
fn a_crawl_ends_with_a_reason() {
    let model = built_in("zx30u-arm").unwrap();
    let recording = common::driven(&model, 10.0, 1e-3, |_, t| 5e-5 * (3.0 * t).sin(), |_| 0.0);
    // Far finer than what it is allowed to take steps for.
    let tolerances = Tolerances { most_steps_per_second: 1.0, ..Tolerances::default().scaled(1e-7) };
    let error = simulate_from_rest(&model, &recording, &[0.0], tolerances).unwrap_err();
    assert!(matches!(error, RunError::Simulation(SimulationError::TooSlow { .. })), "{error:?}");
    let told = error.to_string();
    assert!(told.contains("crawls at") && told.contains("with arm at") && told.contains("cap side"), "{told}");
}
