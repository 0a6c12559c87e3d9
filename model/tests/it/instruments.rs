//! What instruments report: offsets, delays, their derivatives, and the way back from reports to what was.

use crate::common;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Family, Site};
use excavator_model::equations::{Channel, Distortion, System};
use excavator_model::recording::{Recording, cubic, linear};
use excavator_model::scalar::{derivative, variable};
use excavator_model::simulation::{
    InputSignals, Integrator, Observer, Sensitivity, Tolerances, initial_state, observed, simulate_from, undistorted,
};
use excavator_model::{Model, ModelEffect};

/// The arm with sensor effects of these strengths: offsets of displacement, cap, rod and pump pressure, delays of
/// position, chamber pressures and pump pressure.
fn arm_with_poor_instruments(offsets: [f64; 4], delays: [f64; 3]) -> Model {
    let mut model = built_in("zx30u-arm").unwrap();
    for (name, site, values) in [
        ("displacement_sensor_offset", Site::Cylinder(0), vec![offsets[0]]),
        ("pressure_sensor_offset", Site::Cylinder(0), vec![offsets[1], offsets[2]]),
        ("pressure_sensor_offset", Site::PumpLine, vec![offsets[3]]),
        ("sensor_delay", Site::Cylinder(0), vec![delays[0], delays[1]]),
        ("sensor_delay", Site::PumpLine, vec![delays[2]]),
    ] {
        model = model.with_effect(&Catalogue::built_in().find(name).unwrap(), site).unwrap();
        for (parameter, value) in model.effects.last_mut().unwrap().parameters.iter_mut().zip(values) {
            parameter.value = value;
        }
    }
    model
}

fn drive(model: &Model, interval: f64) -> Recording {
    common::driven(model, 2.0, interval, |_, t| 6e-5 * (std::f64::consts::TAU * 0.9 * t + 0.5).sin(), |_| 0.0)
}

fn run(model: &Model, recording: &Recording) -> Recording {
    let signals = InputSignals::from_recording(model, recording).unwrap();
    let start = common::at_rest(&System::new(model));
    simulate_from(model, recording, &signals, start, Tolerances::default()).unwrap()
}

/// Names of the channels that the arm reports.
fn channels(model: &Model) -> Vec<Channel> {
    Channel::all(System::new(model).layout())
}

fn signal(recording: &Recording, model: &Model, channel: Channel) -> Vec<f64> {
    recording.signal(&channel.name(&model.machine)).unwrap().to_vec()
}

#[test]
fn offsets_are_added_to_reports_and_nothing_else() {
    let truth = built_in("zx30u-arm").unwrap();
    let poor = arm_with_poor_instruments([4e-3, 3e4, -2e4, 5e4], [0.0; 3]);
    let (clean, reported) = (run(&truth, &drive(&truth, 1e-3)), run(&poor, &drive(&poor, 1e-3)));
    for channel in channels(&truth) {
        let offset = match channel {
            Channel::Displacement(_) => 4e-3,
            Channel::CapPressure(_) => 3e4,
            Channel::RodPressure(_) => -2e4,
            Channel::PumpPressure => 5e4,
            Channel::JointAngle(_) | Channel::Velocity(_) | Channel::RodForce(_) => 0.0,
        };
        let pairs = signal(&clean, &truth, channel).into_iter().zip(signal(&reported, &poor, channel));
        for (clean, reported) in pairs {
            assert!((reported - clean - offset).abs() <= 1e-9 * offset.abs() + 1e-12, "{channel:?}");
        }
    }
    // One state says the same as far as it can.
    let system = System::new(&poor);
    let mut recording = reported.clone();
    observed(&system, &common::at_rest(&system), 7, &mut recording);
    for channel in channels(&poor) {
        let (one, first) = (signal(&recording, &poor, channel)[7], signal(&reported, &poor, channel)[0]);
        assert!((one - first).abs() <= 1e-12 * first.abs(), "{channel:?} {one} {first}");
    }
}

/// Delays that are no multiple of the samples, against the undelayed simulation at ten times the samples.
#[test]
fn a_delay_reports_the_past() {
    let truth = built_in("zx30u-arm").unwrap();
    let delays = [0.0123, 0.0057, 0.0004];
    let poor = arm_with_poor_instruments([0.0; 4], delays);
    let (fine, reported) = (run(&truth, &drive(&truth, 1e-4)), run(&poor, &drive(&poor, 1e-3)));
    for channel in channels(&truth) {
        let delay = match channel {
            Channel::CapPressure(_) | Channel::RodPressure(_) => delays[1],
            Channel::PumpPressure => delays[2],
            _ => delays[0],
        };
        let (fine_signal, reports) = (signal(&fine, &truth, channel), signal(&reported, &poor, channel));
        let mut errors = Vec::new();
        for (&time, report) in reported.time.iter().zip(&reports) {
            let wanted = linear(&fine.time, &fine_signal, time - delay);
            // The first tenth of a second holds the transient of a start out of balance, which 1 ms does not resolve.
            if time > 0.1 {
                errors.push(report - wanted);
            }
        }
        assert_small(channel, &errors);
        assert_eq!(reports[0], fine_signal[0], "before the start nothing was different: {channel:?}");
    }
}

/// One effect on the whole machine is the same as one at each place.
#[test]
fn a_delay_of_the_whole_machine_is_that_of_each_place() {
    for name in ["zx30u-arm", "zx30u", "emps"] {
        let truth = built_in(name).unwrap();
        let delay = Catalogue::built_in().find("sensor_delay").unwrap();
        let set = |model: &mut Model, values: &[f64]| {
            let parameters = &mut model.effects.last_mut().unwrap().parameters;
            assert_eq!(parameters.len(), values.len(), "{name}");
            parameters.iter_mut().zip(values).for_each(|(parameter, value)| parameter.value = *value);
        };
        let (position, pressure) = (0.0123, 0.0057);
        let values = if truth.machine.has_chambers() { vec![position, pressure] } else { vec![position] };
        let mut whole = truth.with_effect(&delay, Site::Machine).unwrap();
        set(&mut whole, &values);
        let mut placed = truth.clone();
        for (_, site) in truth.parse_addition("sensor_delay").unwrap() {
            placed = placed.with_effect(&delay, site).unwrap();
            let own = if site == Site::PumpLine { vec![pressure] } else { values.clone() };
            set(&mut placed, &own);
        }
        let (whole, placed) = (System::new(&whole), System::new(&placed));
        assert_eq!(whole.own_instruments().of(Channel::Displacement(0)).delay, position, "{name}");
        for channel in Channel::all(whole.layout()) {
            let (one, other) = (whole.own_instruments().of(channel), placed.own_instruments().of(channel));
            assert_eq!(one, other, "{name} {channel:?}");
        }
    }
}

/// A tenth of a good instrument's noise in the mean, and at most about its size where a chamber leaves cavitation: there
/// the pressure has a corner, which no samples show.
fn assert_small(channel: Channel, errors: &[f64]) {
    let worst = errors.iter().map(|error| error.abs()).fold(0.0, f64::max) / common::good_noise(channel);
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    let mean = (squares / errors.len() as f64).sqrt() / common::good_noise(channel);
    println!("{channel:?}: {mean:.1e} of the noise, at most {worst:.1e}");
    assert!(mean < 0.1 && worst < 1.5, "{channel:?}: {mean} of the noise, at most {worst}");
}

/// From reports back to what was, and nothing at the end of a late signal.
#[test]
fn undistorted_is_the_way_back() {
    let truth = built_in("zx30u-arm").unwrap();
    let poor = arm_with_poor_instruments([4e-3, 3e4, -2e4, 5e4], [0.0123, 0.0057, 0.0201]);
    let (clean, reported) = (run(&truth, &drive(&truth, 2e-3)), run(&poor, &drive(&poor, 2e-3)));
    let corrected = undistorted(&poor, &reported);
    for channel in channels(&truth) {
        let (clean, corrected) = (signal(&clean, &truth, channel), signal(&corrected, &poor, channel));
        assert_small(channel, &(50..900).map(|index| clean[index] - corrected[index]).collect::<Vec<_>>());
        assert!(corrected[1000].is_nan(), "{channel:?} cannot be known at the end");
    }
    let same = undistorted(&truth, &clean);
    assert_eq!(same.cylinders[0].displacement, clean.cylinders[0].displacement);
}

/// The state at a sample, from reports of poor instruments by a model that knows of them.
#[test]
fn a_start_is_found_through_poor_instruments() {
    let truth = built_in("zx30u-arm").unwrap();
    let poor = arm_with_poor_instruments([4e-3, 3e4, -2e4, 5e4], [0.012, 0.006, 0.02]);
    let (clean, reported) = (run(&truth, &drive(&truth, 1e-3)), run(&poor, &drive(&poor, 1e-3)));
    let (system, poor_system) = (System::new(&truth), System::new(&poor));
    for sample in [300, 901, 1500] {
        let wanted = initial_state(&system, &clean, sample, &[0.0], 0.0).unwrap();
        let found = initial_state(&poor_system, &reported, sample, &[0.0], 0.0).unwrap();
        for (state, (wanted, found)) in wanted.iter().zip(&found).enumerate() {
            let allowed = if state < 2 { 1e-4 } else { 500.0 };
            assert!((wanted - found).abs() < allowed, "sample {sample}, state {state}: {found}, truly {wanted}");
        }
    }
}

/// Readings of all channels at each tenth sample, and their gradients.
fn observe(model: &Model, parameters: &[f64], start: &[f64], with_gradients: bool) -> (Vec<f64>, Vec<Vec<f64>>) {
    let recording = drive(model, 1e-3);
    let signals = InputSignals::from_recording(model, &recording).unwrap();
    let system = System::new(model);
    let wanted = if with_gradients { model.unknown_parameters() } else { Vec::new() };
    let tolerances = Tolerances { maximum_step: 2e-4, ..Tolerances::default().scaled(1e-2) };
    let mut integrator = Integrator::new(&system, parameters, &wanted, tolerances);
    let mut observer = Observer::new(&system, parameters, &wanted, &Channel::all(system.layout()));
    let mut sensitivity = with_gradients.then(|| Sensitivity::at_start(&system, &wanted));
    let mut state = start.to_vec();
    let (mut readings, mut columns) = (Vec::new(), Vec::new());
    for index in 0..1000 {
        let report = observer.observe(&signals, index, &state, sensitivity.as_ref()).to_vec();
        if index % 10 == 0 {
            readings.extend(report);
            columns.resize(observer.gradients().ncols(), Vec::new());
            for (column, values) in columns.iter_mut().zip(observer.gradients().column_iter()) {
                column.extend(values.iter().copied());
            }
        }
        integrator.advance(&signals, index, &mut state, sensitivity.as_mut()).unwrap();
    }
    (readings, columns)
}

/// Gradients of readings, by sensor parameters, machine parameters and initial states, against differences of whole
/// simulations: what a fit steers by.
#[test]
fn gradients_of_readings_are_slopes() {
    let model = arm_with_poor_instruments([4e-3, 3e4, -2e4, 5e4], [0.0123, 0.0057, 0.0201]);
    let parameters = model.parameter_values();
    let start = common::at_rest(&System::new(&model));
    let (_, gradients) = observe(&model, &parameters, &start, true);
    let wanted = model.unknown_parameters();
    let names = model.parameter_names();
    let channels = channels(&model);
    assert_eq!(gradients.len(), wanted.len() + start.len());
    let mut worst = (0.0, String::new());
    for (column, found) in gradients.iter().enumerate() {
        let moved = |side: f64| {
            let (mut parameters, mut start) = (parameters.clone(), start.clone());
            let step = if let Some(&parameter) = wanted.get(column) {
                let step = 1e-4 * parameters[parameter].abs();
                parameters[parameter] += side * step;
                step
            } else {
                let state = column - wanted.len();
                let step = if state < 2 { 1e-5 } else { 100.0 };
                start[state] += side * step;
                step
            };
            (observe(&model, &parameters, &start, false).0, step)
        };
        let ((upper, step), (lower, _)) = (moved(1.0), moved(-1.0));
        let name = match wanted.get(column) {
            Some(&index) => names[index].clone(),
            None => format!("state {}", column - wanted.len()),
        };
        for (row, channel) in channels.iter().enumerate() {
            let rows = || (row..found.len()).step_by(channels.len());
            let slopes: Vec<f64> = rows().map(|at| (upper[at] - lower[at]) / (2.0 * step)).collect();
            let length = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>().sqrt();
            let size = length(&mut slopes.iter().copied());
            // Of a hundredth of the noise for the whole of the parameter nobody will ever know.
            let whole = wanted.get(column).map_or(1e4 * step, |&index| parameters[index].abs());
            let least = 0.01 * common::good_noise(*channel) / whole * (slopes.len() as f64).sqrt();
            let error = length(&mut rows().zip(&slopes).map(|(at, slope)| found[at] - slope));
            let relative = error / size.max(least);
            if relative > worst.0 {
                worst = (relative, format!("{name} in {channel:?}"));
            }
            // Straight lines between samples of 1 ms blur what sensitivities do where a chamber leaves cavitation.
            assert!(relative < 0.1, "{name} in {channel:?}: {error:e} of {size:e}");
        }
    }
    println!("largest relative error of a gradient: {:.1e} for {}", worst.0, worst.1);
}

/// Where a search starts, the effect already shows in some report: a fit that starts where nothing changes cannot leave.
#[test]
fn every_start_shows_in_reports() {
    for base in ["zx30u-arm", "emps"].map(|name| built_in(name).unwrap()) {
        let recording = common::tour(&base);
        let catalogue = Catalogue::built_in();
        let candidates = catalogue.iter().filter(|physics| physics.card().family == Family::Candidate);
        for (physics, site) in
            candidates.flat_map(|physics| base.free_sites(physics).into_iter().map(move |s| (physics, s)))
        {
            let model = base.with_effect(physics, site).unwrap();
            let shown = shown(&model, &recording);
            let effect: &ModelEffect = model.effects.last().unwrap();
            // Times that a search does not begin with are those of what acts always.
            for (parameter, shown) in effect.parameters.iter().zip(shown).filter(|(parameter, _)| !parameter.known) {
                let label = common::label(&model, model.effects.len() - 1);
                println!("{label} {}: {shown:.1e}", parameter.card.name);
                assert!(shown > 0.05, "{label} {}: {shown:e} times the noise", parameter.card.name);
            }
        }
    }
}

/// Per parameter of the last effect: largest change of any report, to first order, for a change by the typical size, in
/// units of a good instrument's noise.
fn shown(model: &Model, recording: &Recording) -> Vec<f64> {
    let system = System::new(model);
    let parameters = model.parameter_values();
    let own = model.effects.last().unwrap().parameters.len();
    let wanted: Vec<usize> = (parameters.len() - own..parameters.len()).collect();
    let signals = InputSignals::from_recording(model, recording).unwrap();
    let channels = Channel::all(system.layout());
    let mut integrator = Integrator::new(&system, &parameters, &wanted, Tolerances::default());
    let mut observer = Observer::new(&system, &parameters, &wanted, &channels);
    let mut state = common::at_rest(&system);
    let mut sensitivity = Sensitivity::at_start(&system, &wanted);
    let mut shown = vec![0.0_f64; own];
    for index in 0..signals.len() - 1 {
        observer.observe(&signals, index, &state, Some(&sensitivity));
        for (column, (shown, parameter)) in shown.iter_mut().zip(&model.effects.last().unwrap().parameters).enumerate()
        {
            for (row, channel) in channels.iter().enumerate() {
                let change = observer.gradients()[(row, column)] * parameter.card.typical;
                *shown = shown.max((change / common::good_noise(*channel)).abs());
            }
        }
        integrator.advance(&signals, index, &mut state, Some(&mut sensitivity)).unwrap();
    }
    shown
}

/// The true value as a function of the sensor effects' parameters.
#[test]
fn truth_carries_the_derivatives_of_offset_and_delay() {
    let distortion = Distortion { offset: variable(3e4, 0), delay: variable(0.01, 1) };
    let truth = distortion.truth(1.2e6, 5e5);
    assert_eq!((truth.re, derivative(&truth, 0), derivative(&truth, 1)), (1.2e6, -1.0, 5e5));
}

/// Cubics are followed exactly on an uneven clock; next to a hole a straight line, in it nothing.
#[test]
fn cubics_are_interpolated_exactly() {
    let time = [0.0, 0.9, 2.1, 3.0, 4.2, 5.0, 6.1];
    let law = |t: f64| 2.0 - t + 0.3 * t * t - 0.05 * t * t * t;
    let mut values: Vec<f64> = time.iter().map(|&t| law(t)).collect();
    for at in [0.9, 1.3, 2.5, 4.19, 4.9] {
        assert!((cubic(&time, &values, at) - law(at)).abs() < 1e-12, "{at}");
    }
    assert!((cubic(&time, &values, 0.45) - (law(0.0) + law(0.9)) / 2.0).abs() < 1e-12);
    assert!((cubic(&time, &values, 6.1) - law(6.1)).abs() < 1e-12);
    values[5] = f64::NAN;
    assert!((cubic(&time, &values, 3.6) - (law(3.0) + law(4.2)) / 2.0).abs() < 1e-12);
    assert!(cubic(&time, &values, 4.5).is_nan() && cubic(&time, &values, -0.1).is_nan());
    assert!(cubic(&time, &values, 6.2).is_nan() && cubic(&[], &[], 0.0).is_nan());
}
