//! The instruments do what the practice recordings' say.

use excavator_blind::instruments::{Instruments, record};
use excavator_blind::plant::{Extras, Sensors, TANK_PRESSURE};
use excavator_blind::run::{POINTS, RATE, Truth};
use excavator_model::recording::Recording;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const SAMPLES: usize = 20_000;

fn recorded(sensors: &Sensors, noise: f64, spool_sensor: bool) -> Recording {
    let ramp: Vec<f64> = (0..SAMPLES * POINTS).map(|point| 1e-6 * point as f64).collect();
    let flat = vec![1e6; SAMPLES * POINTS];
    let truth = Truth {
        displacement: ramp,
        velocity: vec![0.0; SAMPLES * POINTS],
        cap: flat.clone(),
        rod: flat.clone(),
        pump: flat,
        spool: vec![1e-5; SAMPLES * POINTS],
        command: vec![1e-5; SAMPLES],
    };
    let instruments = Instruments { noise, spool_sensor, ..Instruments::default() };
    record(&truth, sensors, &Extras::none(), &instruments, "test", &mut ChaCha8Rng::seed_from_u64(9))
}

fn deviation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn noise_loss_and_jitter_have_their_sizes() {
    let recording = recorded(&Sensors::default(), 1.0, true);
    recording.validate().unwrap();
    let lost = SAMPLES - recording.len();
    assert!((5..=45).contains(&lost), "{lost} lost of {SAMPLES} at 0.1 %");
    assert!((deviation(&recording.cylinders[0].cap_pressure) / 2e3 - 1.0).abs() < 0.03);
    assert!((deviation(&recording.tank_pressure) / 2e3 - 1.0).abs() < 0.03);
    assert!((deviation(&recording.cylinders[0].orifice_area) / 2e-7 - 1.0).abs() < 0.03);
    let steps: Vec<f64> =
        recording.time.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step < 1.5 / RATE).collect();
    assert!((deviation(&steps) / (2e-5 * 2.0_f64.sqrt()) - 1.0).abs() < 0.03, "{}", deviation(&steps));
    assert!(recording.cylinders[0].velocity.iter().all(|value| value.is_nan()));
}

#[test]
fn values_stand_on_the_steps_of_their_converters() {
    let recording = recorded(&Sensors::default(), 1.0, true);
    for (values, range) in [
        (&recording.cylinders[0].displacement, 0.7),
        (&recording.pump_pressure, 25e6),
        (&recording.tank_pressure, 25e6),
    ] {
        let step = range / 65_536.0;
        assert!(values.iter().all(|value| ((value / step).round() - value / step).abs() < 1e-6));
    }
}

#[test]
fn no_noise_at_factor_nought_and_no_spool_where_no_sensor_is() {
    let recording = recorded(&Sensors::default(), 0.0, false);
    assert!(recording.tank_pressure.iter().all(|value| (value - TANK_PRESSURE).abs() < 200.0));
    assert!(recording.cylinders[0].orifice_area.iter().all(|value| value.is_nan()));
    assert!(recording.cylinders[0].orifice_command.iter().all(|value| *value == 1e-5));
}

#[test]
fn offsets_and_delays_are_what_they_say() {
    let plain = recorded(&Sensors::default(), 0.0, true);
    let sensors =
        Sensors { displacement_offset: 0.01, displacement_delay: 0.004, cap_offset: 5e4, ..Sensors::default() };
    let wrong = recorded(&sensors, 0.0, true);
    let half = plain.len() / 2;
    // The ramp climbs 2 mm/s on this clock of points: 4 ms are 8 steps of 1 um.
    let shift = wrong.cylinders[0].displacement[half] - plain.cylinders[0].displacement[half];
    assert!((shift - 0.01 + 8e-6).abs() < 1.2e-5, "{shift}");
    let offset = wrong.cylinders[0].cap_pressure[half] - plain.cylinders[0].cap_pressure[half];
    assert!((offset - 5e4).abs() < 400.0, "{offset}");
    assert_eq!(wrong.cylinders[0].rod_pressure, plain.cylinders[0].rod_pressure);
}
