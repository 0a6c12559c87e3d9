//! The monitor along a simulated trajectory: complete, closed, and not thrown off by what networks do to samples.

use crate::common;
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::energy::monitor::{Balance, Monitor, Settings, Watch, WatchSettings, Window};
use excavator_model::equations::System;
use excavator_model::recording::{CylinderSample, Recording, Sample};
use excavator_model::simulation::{InputSignals, Tolerances, simulate_from};

const PERIOD: i64 = 1_000_000;

/// Three seconds of an arm that moves to and fro, 1 kHz, without noise.
fn recording(model: &Model) -> Recording {
    driven_by(model, |number: usize, t: f64| 5e-5 * (std::f64::consts::TAU * 0.7 * t + number as f64).sin())
}

fn driven_by(model: &Model, area: impl Fn(usize, f64) -> f64) -> Recording {
    let driven = common::driven(model, 3.0, 1e-3, area, |_| 0.0);
    let signals = InputSignals::from_recording(model, &driven).unwrap();
    let state = common::at_rest(&System::new(model));
    simulate_from(model, &driven, &signals, state, Tolerances::default().scaled(0.01)).unwrap()
}

fn samples(model: &Model, recording: &Recording, with_velocity: bool) -> Vec<Sample> {
    (0..recording.len())
        .map(|index| Sample {
            nanoseconds: 1_700_000_000_000_000_000 + index as i64 * PERIOD,
            cylinders: model
                .machine
                .cylinders
                .iter()
                .map(|cylinder| {
                    let signals = recording.cylinder(&cylinder.name).unwrap();
                    CylinderSample {
                        joint_angle: f64::NAN,
                        displacement: signals.displacement[index],
                        velocity: if with_velocity { signals.velocity[index] } else { f64::NAN },
                        cap_pressure: signals.cap_pressure[index],
                        rod_pressure: signals.rod_pressure[index],
                        orifice_area: signals.orifice_area[index],
                        rod_force: f64::NAN,
                    }
                })
                .collect(),
            pump_pressure: recording.pump_pressure[index],
            tank_pressure: f64::NAN,
            pump_flow: f64::NAN,
        })
        .collect()
}

fn monitored(model: &Model, samples: impl IntoIterator<Item = Sample>) -> (Vec<Balance>, Vec<Window>) {
    let system = System::new(model);
    let mut monitor = Monitor::new(&system, Settings::default());
    let mut balances = Vec::new();
    for sample in samples {
        monitor.push(sample, &mut balances);
    }
    monitor.flush(&mut balances);
    let mut watch = Watch::new(WatchSettings::default());
    let windows = balances.iter().filter_map(|balance| watch.push(balance)).collect();
    (balances, windows)
}

#[test]
fn every_state_gets_one_balance_with_its_stamp() {
    let model = built_in("zx30u-arm").unwrap();
    let recording = recording(&model);
    for with_velocity in [true, false] {
        let samples = samples(&model, &recording, with_velocity);
        let stamps: Vec<i64> = samples.iter().map(|sample| sample.nanoseconds).collect();
        let (balances, _) = monitored(&model, samples);
        assert_eq!(balances.iter().map(|balance| balance.nanoseconds).collect::<Vec<_>>(), stamps);
    }
}

#[test]
fn a_balance_comes_exactly_one_delay_after_its_state() {
    let model = built_in("zx30u-arm").unwrap();
    let recording = recording(&model);
    for with_velocity in [true, false] {
        let system = System::new(&model);
        let mut monitor = Monitor::new(&system, Settings::default());
        let delay = (monitor.delay(with_velocity) * 1e9).round() as i64;
        let mut balances = Vec::new();
        for sample in samples(&model, &recording, with_velocity).into_iter().take(500) {
            let now = sample.nanoseconds;
            balances.clear();
            monitor.push(sample, &mut balances);
            for balance in &balances {
                assert_eq!(now - balance.nanoseconds, delay, "with velocity: {with_velocity}");
            }
        }
        assert_eq!(balances.len(), 1);
    }
}

#[test]
fn the_balance_of_the_true_model_closes() {
    for name in ["zx30u-arm", "zx30u"] {
        let model = built_in(name).unwrap();
        let recording = recording(&model);
        for with_velocity in [true, false] {
            let (balances, windows) = monitored(&model, samples(&model, &recording, with_velocity));
            let inner = &balances[100..balances.len() - 100];
            let size = |of: fn(&Balance) -> f64| inner.iter().map(|balance| of(balance).abs()).sum::<f64>();
            let residual = size(|balance| balance.cylinders.iter().map(|cylinder| cylinder.residual()).sum());
            let through = size(|balance| balance.cylinders.iter().map(|cylinder| cylinder.supply).sum());
            let share = residual / through;
            println!("{name}, velocity measured: {with_velocity}: residual {share:.2e} of the supply");
            // The parabola over 20 ms rounds off what changes faster; nothing else is left.
            assert!(share < 0.02, "{name}: {share}");
            assert!(windows.len() >= 2);
            for window in windows {
                assert!(!window.violates_passivity(), "{window:?}");
                assert!(
                    window.residual().abs() < 0.01 * (window.supplied.abs() + window.dissipated.abs()) / window.length
                );
            }
        }
    }
}

#[test]
fn missing_physics_is_told_and_noise_is_not() {
    let model = built_in("zx30u-arm").unwrap();
    let recording = recording(&model);
    let mut poorer = model.clone();
    poorer.effects.retain(|effect| effect.name() != "viscous_damping");
    let mut noise = common::Random(3);
    let noisy: Vec<Sample> = samples(&model, &recording, true)
        .into_iter()
        .map(|mut sample| {
            for cylinder in &mut sample.cylinders {
                cylinder.displacement += 2e-5 * noise.normal();
                cylinder.cap_pressure += 20.0 * noise.normal();
                cylinder.rod_pressure += 20.0 * noise.normal();
            }
            sample
        })
        .collect();
    let (_, right) = monitored(&model, noisy.clone());
    let (_, wrong) = monitored(&poorer, noisy);
    println!("right: {right:?}\nwrong: {wrong:?}");
    assert!(right.iter().all(Window::is_explained), "{right:?}");
    assert!(wrong.iter().all(|window| !window.is_explained()), "{wrong:?}");
}

#[test]
fn without_noise_the_true_model_is_explained_and_a_wrong_one_is_not() {
    for name in ["zx30u-arm", "zx30u"] {
        let model = built_in(name).unwrap();
        let moving = samples(&model, &recording(&model), true);
        // With the valves closed oil leaks, and what moves moves slowly.
        let resting = samples(&model, &driven_by(&model, |_, _| 0.0), true);
        for (what, samples) in [("moving", moving.clone()), ("resting", resting)] {
            let (_, windows) = monitored(&model, samples);
            for window in &windows {
                let unexplained = window.residual() * window.length;
                println!("{name}, {what}: {unexplained:.2e} J of {:.2e} J", window.resolution);
            }
            assert!(windows.len() >= 2 && windows.iter().all(Window::is_explained), "{name}, {what}: {windows:?}");
        }
        let mut wrong = model.clone();
        for effect in wrong.effects.iter_mut().filter(|effect| effect.name() == "viscous_damping") {
            effect.parameters[0].value *= 0.9;
        }
        let (_, windows) = monitored(&wrong, moving);
        assert!(windows.iter().all(|window| !window.is_explained()), "{name}: {windows:?}");
    }
}

#[test]
fn energy_out_of_nothing_violates_passivity() {
    let model = built_in("zx30u-arm").unwrap();
    let recording = recording(&model);
    let charging = samples(&model, &recording, true).into_iter().map(|mut sample| {
        // A pressure sensor that drifts upwards fills the chamber with energy that no pump has delivered.
        let drift = (sample.nanoseconds - 1_700_000_000_000_000_000) as f64 * 1e-9 * 4e6;
        sample.cylinders[0].cap_pressure += drift;
        sample.cylinders[0].orifice_area = 0.0;
        sample
    });
    let (_, windows) = monitored(&model, charging);
    assert!(windows.iter().any(Window::violates_passivity), "{windows:?}");
}

#[test]
fn what_networks_do_to_samples_is_survived_and_counted() {
    let model = built_in("zx30u-arm").unwrap();
    let recording = recording(&model);
    let clean = samples(&model, &recording, true);
    let system = System::new(&model);
    let mut monitor = Monitor::new(&system, Settings::default());
    let mut balances = Vec::new();
    let mut push = |sample: &Sample| monitor.push(sample.clone(), &mut balances);
    clean[..500].iter().for_each(&mut push);
    push(&clean[499]);
    push(&clean[480]);
    // Half a second is lost.
    clean[1000..1500].iter().for_each(&mut push);
    // The clock goes back by an hour.
    for sample in &clean[1500..2000] {
        push(&Sample { nanoseconds: sample.nanoseconds - 3_600_000_000_000, ..sample.clone() });
    }
    // A sensor fails for one sample, another one for good.
    let mut broken = clean[2000].clone();
    broken.nanoseconds -= 3_600_000_000_000;
    broken.cylinders[0].cap_pressure = f64::NAN;
    broken.pump_pressure = f64::INFINITY;
    push(&broken);
    monitor.flush(&mut balances);
    let counts = monitor.counts();
    assert_eq!((counts.duplicates, counts.out_of_order, counts.gaps, counts.jumps), (1, 1, 1, 1));
    assert_eq!((counts.states, counts.balances), (1501, 1501));
    assert_eq!(balances.len(), 1501);
    let complete = balances.iter().filter(|balance| balance.cylinders[0].residual().is_finite()).count();
    assert_eq!(counts.incomplete as usize, balances.len() - complete);
    // At each of the six ends of the three pieces a few states have no window on both sides.
    assert!(complete >= 1501 - 6 * 3, "{complete}");
    assert!(complete < 1501);
}

#[test]
fn extreme_stamps_and_values_do_not_panic() {
    let model = built_in("zx30u").unwrap();
    let system = System::new(&model);
    let mut monitor = Monitor::new(&system, Settings::default());
    let mut balances = Vec::new();
    let stamps = [i64::MIN, i64::MAX, 0, -1, i64::MIN, i64::MAX, i64::MAX - 1];
    for nanoseconds in stamps {
        for value in [f64::NAN, f64::INFINITY, f64::MAX, -1e300, 0.0] {
            let cylinder = CylinderSample { displacement: value, velocity: value, ..CylinderSample::unmeasured() };
            let sample = Sample {
                nanoseconds,
                cylinders: vec![cylinder],
                pump_pressure: value,
                tank_pressure: value,
                pump_flow: value,
            };
            monitor.push(sample, &mut balances);
        }
    }
    monitor.flush(&mut balances);
    assert_eq!(monitor.counts().balances, monitor.counts().states);
}
