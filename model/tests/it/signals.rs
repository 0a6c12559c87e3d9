//! Profiles, interpolation, denoising, recordings.

use crate::common;
use crate::common::Random;
use excavator_model::document::built_in;
use excavator_model::equations::Inputs;
use excavator_model::recording::{
    Recording, RecordingError, denoised, denoised_towards_zero, is_measured, linear, noise_level, zero_order_hold,
};
use excavator_model::simulation::{InputSignals, Profile, ProfileError, Segment, initial_state, simulate};

fn near(found: f64, wanted: f64) {
    assert!((found - wanted).abs() < 1e-18, "{found} {wanted}");
}

#[test]
fn segments_have_their_shapes() {
    let sine = Segment::Sine { duration: 4.0, amplitude: 1e-4, frequency: 0.5 };
    near(sine.area(0.5), 1e-4);
    near(sine.area(1.5), -1e-4);
    assert_eq!(sine.duration(), 4.0);
    let trapezoid = Segment::Trapezoid { duration: 3.0, amplitude: -6e-5, ramp: 0.5 };
    for (time, share) in [(0.0, 0.0), (0.25, 0.5), (0.5, 1.0), (2.5, 1.0), (2.75, 0.5), (3.0, 0.0)] {
        near(trapezoid.area(time), -6e-5 * share);
    }
    near(Segment::Hold { duration: 1.0, area: 2e-5 }.area(0.7), 2e-5);
}

/// Frequency of a sweep, from the times between its zero crossings.
#[test]
fn a_sweep_runs_from_one_frequency_to_the_other() {
    let sweep = Segment::Sweep { duration: 20.0, amplitude: 1.0, from_frequency: 0.5, to_frequency: 3.0 };
    let time = |index: i32| f64::from(index) * 1e-5;
    let crossings: Vec<f64> = (0..1_999_999)
        .filter(|&index| sweep.area(time(index)) < 0.0 && sweep.area(time(index + 1)) >= 0.0)
        .map(time)
        .collect();
    for pair in crossings.windows(2) {
        let (frequency, middle) = (1.0 / (pair[1] - pair[0]), (pair[0] + pair[1]) / 2.0);
        let wanted = 0.5 + (3.0 - 0.5) * middle / 20.0;
        assert!((frequency - wanted).abs() < 0.02 * wanted, "{middle} s: {frequency} Hz, wanted {wanted} Hz");
    }
    assert!(crossings.len() > 30);
}

#[test]
fn a_profile_runs_its_segments_one_after_the_other() {
    let profile = Profile {
        cylinder: "arm".into(),
        segments: vec![
            Segment::Hold { duration: 1.0, area: 1e-5 },
            Segment::Trapezoid { duration: 2.0, amplitude: 4e-5, ramp: 0.5 },
            Segment::Hold { duration: 1.0, area: -1e-5 },
        ],
    };
    assert_eq!(profile.duration(), 4.0);
    profile.check().unwrap();
    for (time, area) in [(-0.1, 0.0), (0.0, 1e-5), (0.99, 1e-5), (1.25, 2e-5), (2.0, 4e-5), (3.0, -1e-5), (4.0, 0.0)] {
        near(profile.area(time), area);
    }
}

#[test]
fn impossible_profiles_are_refused() {
    for segment in [
        Segment::Hold { duration: 0.0, area: 1e-5 },
        Segment::Hold { duration: f64::NAN, area: 1e-5 },
        Segment::Trapezoid { duration: 1.0, amplitude: 1e-5, ramp: -1.0 },
        Segment::Sine { duration: 1.0, amplitude: 1e-5, frequency: 0.0 },
        Segment::Sine { duration: 1.0, amplitude: f64::NAN, frequency: 1.0 },
        Segment::Hold { duration: 1.0, area: f64::INFINITY },
        Segment::Trapezoid { duration: 1.0, amplitude: 1e-5, ramp: 0.6 },
        Segment::Sweep { duration: 1.0, amplitude: 1e-5, from_frequency: -1.0, to_frequency: 2.0 },
        Segment::Sweep { duration: 1.0, amplitude: 1e-5, from_frequency: 0.1, to_frequency: f64::NAN },
    ] {
        let profile = Profile { cylinder: "arm".into(), segments: vec![segment] };
        assert!(matches!(profile.check(), Err(ProfileError::Impossible { .. })), "{segment:?}");
    }
    let nothing = Profile { cylinder: "arm".into(), segments: Vec::new() };
    assert!(nothing.check().unwrap_err().to_string().contains("arm has no segments"));
}

#[test]
fn values_between_samples() {
    let (time, values) = ([0.0, 1.0, 3.0], [2.0, 4.0, 0.0]);
    for (at, wanted) in [(-1.0, 2.0), (0.0, 2.0), (0.25, 2.5), (1.0, 4.0), (2.5, 1.0), (3.0, 0.0), (9.0, 0.0)] {
        assert_eq!(linear(&time, &values, at), wanted, "{at}");
    }
    for (at, wanted) in [(0.0, 2.0), (0.99, 2.0), (1.0, 4.0), (2.99, 4.0), (3.0, 0.0), (9.0, 0.0)] {
        assert_eq!(zero_order_hold(&time, &values, at), wanted, "{at}");
    }
    assert!(zero_order_hold(&time, &values, -0.1).is_nan());
    assert!(linear(&[], &[], 0.0).is_nan());
    assert!(linear(&time, &[2.0, f64::NAN, 0.0], 0.5).is_nan());
}

#[test]
fn inputs_run_as_straight_lines_and_commands_are_held() {
    let model = built_in("zx30u-arm").unwrap();
    let mut recording = common::driven(&model, 0.02, 0.01, |_, t| 1e-3 * t, |_| 0.0);
    let mut inputs = Inputs::zero(1);
    let signals = InputSignals::from_recording(&model, &recording).unwrap();
    signals.between(0, 0.5, &mut inputs);
    near(inputs.orifice_area[0], 5e-6);
    signals.between(0, 1.0, &mut inputs);
    assert_eq!(inputs.orifice_area[0], signals.orifice_area(0)[1]);
    assert_eq!(inputs.pump_flow, 3.8e-4);
    recording.cylinders[0].orifice_area.fill(f64::NAN);
    recording.cylinders[0].orifice_command = vec![f64::NAN, 2e-5, 3e-5];
    let signals = InputSignals::from_recording(&model, &recording).unwrap();
    for (index, fraction, wanted) in [(0, 0.9, 0.0), (1, 0.0, 2e-5), (1, 0.9, 2e-5), (2, 0.0, 3e-5)] {
        signals.between(index, fraction, &mut inputs);
        assert_eq!(inputs.orifice_area[0], wanted, "{index} {fraction}");
    }
    recording.cylinders[0].orifice_command.fill(f64::NAN);
    let text = InputSignals::from_recording(&model, &recording).unwrap_err().to_string();
    assert!(text.contains("arm.orifice_area") && !text.contains('\n'), "{text}");
}

#[test]
fn a_clean_signal_is_not_touched() {
    let held: Vec<f64> = (0..500).map(|index| if index < 250 { 1.0 } else { 3.0 }).collect();
    assert_eq!(denoised(&held), held);
    let ramps: Vec<f64> = (0..500).map(|index| f64::from((index - 250).max(0)) * 0.5).collect();
    assert_eq!(denoised(&ramps), ramps);
    assert_eq!(denoised(&[]), Vec::<f64>::new());
    assert_eq!(denoised(&[1.0, 2.0]), [1.0, 2.0]);
}

#[test]
fn noise_is_measured_and_removed_from_a_held_signal() {
    let mut random = Random(21);
    let noise = 2e-3;
    let noisy: Vec<f64> = (0..4000).map(|_| 5.0 + noise * random.normal()).collect();
    let level = noise_level(&noisy);
    assert!((level / noise - 1.0).abs() < 0.1, "{level}");
    let rest = denoised(&noisy);
    let deviation = |signal: &[f64]| (signal.iter().map(|v| (v - 5.0).powi(2)).sum::<f64>() / 4000.0).sqrt();
    println!("noise on a held signal shrinks to {:.2}", deviation(&rest) / deviation(&noisy));
    assert!(deviation(&rest) < 0.4 * deviation(&noisy), "{}", deviation(&rest) / deviation(&noisy));
}

/// What a servo model leaves of a spool's signal is zero but for a wave that is well beyond the noise.
#[test]
fn what_may_be_noise_becomes_zero() {
    let mut random = Random(23);
    let noise = 2e-7;
    let wave = |index: usize| 5.0 * noise * (std::f64::consts::PI * (index as f64 - 2000.0) / 200.0).sin();
    let noisy: Vec<f64> = (0..4000)
        .map(|index| noise * random.normal() + if (2000..2200).contains(&index) { wave(index) } else { 0.0 })
        .collect();
    let rest = denoised_towards_zero(&noisy, 0.0);
    let quiet: Vec<f64> = rest[..1900].iter().chain(&rest[2300..]).map(|value| value.abs()).collect();
    let zero = quiet.iter().filter(|&&value| value == 0.0).count() as f64 / quiet.len() as f64;
    let largest = quiet.iter().copied().fold(0.0, f64::max);
    println!("{:.1} % of pure noise is zero, the largest {:.2} of it", 100.0 * zero, largest / noise);
    assert!(zero > 0.98 && largest < noise, "{zero} {largest}");
    assert!((2080..2120).all(|index| (rest[index] - wave(index)).abs() < 1.5 * noise));
}

/// A valve with play ends where its spool came last: one reading in a recording of a minute that is taken for motion moves it for
/// the rest of the hold. Chance has 40 000 tries.
#[test]
fn nothing_is_left_of_the_noise_of_a_resting_spool() {
    let noise = 2e-7;
    let moved: usize = (0..20)
        .map(|seed| {
            let mut random = Random(100 + seed);
            let noisy: Vec<f64> = (0..40_000).map(|_| noise * random.normal()).collect();
            denoised_towards_zero(&noisy, 0.0).iter().filter(|value| value.abs() > 0.1 * noise).count()
        })
        .sum();
    println!("{moved} of 800000 readings of a resting spool are taken for motion");
    assert!(moved <= 8, "{moved}");
}

/// A step of twenty times the noise and the corner of a ramp stay where they were.
#[test]
fn edges_stay() {
    let mut random = Random(22);
    let noise = 0.05;
    let step = |index: usize| if index < 1000 { 0.0 } else { 1.0 };
    let noisy: Vec<f64> = (0..2000).map(|index| step(index) + noise * random.normal()).collect();
    let rest = denoised(&noisy);
    for (index, value) in rest.iter().enumerate().take(1020).skip(980) {
        assert!((value - step(index)).abs() < 4.0 * noise, "{index}: {value}");
    }
    let ramp = |index: usize| (index as f64 - 1000.0).max(0.0) * 0.01;
    let noisy: Vec<f64> = (0..2000).map(|index| ramp(index) + noise * random.normal()).collect();
    let rest = denoised(&noisy);
    let squares = |signal: &[f64]| (900..1100).map(|index| (signal[index] - ramp(index)).powi(2)).sum::<f64>();
    assert!(squares(&rest) < 0.5 * squares(&noisy), "{} {}", squares(&rest), squares(&noisy));
}

#[test]
fn recordings_keep_their_promises() {
    let mut recording = Recording::unmeasured("bag", vec![0.0, 0.1, 0.2], &["boom", "arm"]);
    recording.validate().unwrap();
    assert_eq!((recording.len(), recording.duration()), (3, 0.2));
    assert!((recording.sample_interval() - 0.1).abs() < 1e-15);
    assert_eq!(recording.signals().len(), 2 * 8 + 4);
    assert!(recording.signals().iter().all(|(_, signal)| !is_measured(signal)));
    assert!(recording.signal("arm.cap_pressure").is_some() && recording.signal("arm.colour").is_none());
    let text = recording.cylinder("bucket").unwrap_err().to_string();
    assert!(text.contains("\"boom\", \"arm\""), "{text}");
    recording.time[2] = 0.1;
    assert!(matches!(recording.validate(), Err(RecordingError::ClockNotIncreasing { index: 2, .. })));
    recording.time[2] = f64::NAN;
    assert!(matches!(recording.validate(), Err(RecordingError::ClockNotIncreasing { index: 2, .. })));
    recording.time[2] = 0.2;
    recording.cylinders[1].velocity.pop();
    let error = recording.validate().unwrap_err();
    assert!(matches!(&error, RecordingError::LengthMismatch { signal, .. } if signal == "arm.velocity"), "{error}");
}

/// A simulation started from a recording of itself goes on as it did.
#[test]
fn a_simulation_repeats_itself_from_its_own_recording() {
    let model = built_in("zx30u").unwrap();
    let mut recording = common::driven(&model, 3.0, 1e-3, |n, t| 5e-5 * (3.0 * t + n as f64).sin(), |_| 0.0);
    for (cylinder, signals) in model.machine.cylinders.iter().zip(&mut recording.cylinders) {
        signals.displacement.fill(0.0);
        signals.joint_angle.fill(cylinder.linkage.joint(0.0));
        signals.cap_pressure.fill(1e6);
        signals.rod_pressure.fill(1e6);
    }
    recording.pump_pressure.fill(1e6);
    let simulated = simulate(&model, &recording).unwrap();
    simulated.validate().unwrap();
    let system = excavator_model::equations::System::new(&model);
    let start = initial_state(&system, &simulated, 1500, &[0.0, 0.0], 0.0).unwrap();
    for (cylinder, signals) in simulated.cylinders.iter().enumerate() {
        assert!((start[cylinder] - signals.joint_angle[1500]).abs() < 1e-5);
        assert!((start[4 + 2 * cylinder] - signals.cap_pressure[1500]).abs() < 2e3);
    }
    assert!((start[8] - simulated.pump_pressure[1500]).abs() < 2e3);
}

#[test]
fn means_lower_the_rate_and_do_not_cross_a_pause() {
    let time = (0..10).map(|k| f64::from(k) * 0.01 + if k < 5 { 0.0 } else { 30.0 }).collect();
    let mut recording = Recording::unmeasured("paused", time, &["arm"]);
    recording.pump_pressure = (0..10).map(f64::from).collect();
    let slow = recording.averaged(2);
    assert_eq!(slow.len(), 5);
    assert!((slow.time[0] - 0.005).abs() < 1e-12);
    assert_eq!(slow.pump_pressure[..2], [0.5, 2.5]);
    assert!(slow.pump_pressure[2].is_nan());
    assert_eq!(slow.pump_pressure[3..], [6.5, 8.5]);
}
