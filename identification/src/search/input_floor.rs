//! Error that the uncertainty of the inputs leaves: they are known only at samples and with sensor noise.

use excavator_model::Model;
use excavator_model::equations::{Channel, System};
use excavator_model::recording::{Recording, noise_level};
use excavator_model::simulation::simulate;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::fit::{Fit, FitSettings, Instrument, evaluate};

/// Error variance that the readings of the inputs alone cause in each instrument of `evaluated`, a model on
/// `recordings`, over the variance of the instrument's noise. Returns `None` if that cannot be simulated.
///
/// The time at which a valve moved between two samples is not known: it can be anywhere in the interval, independently
/// each time. Its position is known except for sensor noise, which is magnified by a pump that feeds two nearly open
/// valves. The resulting output error is found by fitting the model to its own outputs for inputs that were read again:
/// with another time for each move, as far as the move is larger than its neighbours, and with new noise.
pub(super) fn input_floor(evaluated: &Fit, recordings: &[&Recording], settings: &FitSettings) -> Option<Vec<f64>> {
    let model = &evaluated.model;
    let disturbed: Option<Vec<Recording>> =
        recordings.iter().map(|recording| answer_to_other_readings(model, recording)).collect();
    let disturbed = disturbed?;
    let left = evaluate(model, &disturbed.iter().collect::<Vec<_>>(), settings).ok()?;
    let floor = |instrument: &Instrument| {
        let position = left.instruments.iter().position(|own| own.name == instrument.name)?;
        Some((left.errors[position] / instrument.noise).powi(2))
    };
    evaluated.instruments.iter().map(floor).collect()
}

/// The readings of the model's instruments for inputs that were read again, together with the original inputs.
fn answer_to_other_readings(model: &Model, recording: &Recording) -> Option<Recording> {
    let simulated = simulate(model, &with_other_readings(model, recording)).ok()?;
    let mut answer = recording.clone();
    let imposed = model.machine.has_imposed_motion();
    let is_output = |channel: &Channel| !imposed || matches!(channel, Channel::RodForce(_));
    for channel in Channel::all(System::new(model).layout()).into_iter().filter(is_output) {
        let reported = simulated.signal(&channel.name(&model.machine))?.to_vec();
        let Some(measured) = channel.signal_mut(&model.machine, &mut answer) else { continue };
        for (slot, value) in measured.iter_mut().zip(reported) {
            if slot.is_finite() {
                *slot = value;
            }
        }
    }
    Some(answer)
}

fn with_other_readings(model: &Model, recording: &Recording) -> Recording {
    let mut again = recording.clone();
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let (imposed, chambers) = (model.machine.has_imposed_motion(), model.machine.has_chambers());
    for cylinder in &mut again.cylinders {
        // A command is not measured, so it has no sensor noise.
        move_within_intervals(&mut cylinder.orifice_command, &mut random);
        read_again(&mut cylinder.orifice_area, &mut random);
        if imposed {
            read_again(&mut cylinder.displacement, &mut random);
            read_again(&mut cylinder.joint_angle, &mut random);
        } else if !chambers {
            read_again(&mut cylinder.rod_force, &mut random);
        }
    }
    again
}

fn read_again(signal: &mut [f64], random: &mut ChaCha8Rng) {
    let noise = noise_level(signal);
    move_within_intervals(signal, random);
    for value in signal {
        let normal: f64 = StandardNormal.sample(random);
        *value += noise * normal;
    }
}

/// Arbitrary but fixed, so that the same recordings get the same verdict.
const SEED: u64 = 1;

/// A change of a signal below this number of noise levels counts as none.
const DOUBT: f64 = 5.0;

/// Shifts the time of each move within its interval. The shift is half an interval over the square root of three, the
/// standard deviation of a uniformly distributed time in it.
fn move_within_intervals(signal: &mut [f64], random: &mut ChaCha8Rng) {
    let least = DOUBT * noise_level(signal);
    let changes: Vec<f64> = signal.windows(2).map(|pair| pair[1] - pair[0]).collect();
    for (interval, &here) in changes.iter().enumerate() {
        let before = interval.checked_sub(1).map_or(here, |before| changes[before]);
        let after = changes.get(interval + 1).copied().unwrap_or(here);
        let more = if (here - before).abs() < (here - after).abs() { here - before } else { here - after };
        // A move into or out of a hole is NaN, and the comparison rejects it.
        if more.abs() > least {
            let by = 0.5 / 3.0_f64.sqrt() * more;
            if random.random() { signal[interval] += by } else { signal[interval + 1] -= by }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_may_have_happened_anywhere_in_its_interval_and_a_ramp_is_what_it_is() {
        let random = &mut ChaCha8Rng::seed_from_u64(3);
        let ramp: Vec<f64> = (0..50).map(|k| 0.2 * f64::from(k)).collect();
        let mut moved = ramp.clone();
        move_within_intervals(&mut moved, random);
        assert!(ramp.iter().zip(moved).all(|(a, b)| (a - b).abs() < 1e-12));

        let jump: Vec<f64> = (0..50).map(|k| f64::from(u8::from(k > 20))).collect();
        let mut shift = || {
            let mut moved = jump.clone();
            move_within_intervals(&mut moved, random);
            moved.iter().sum::<f64>() - jump.iter().sum::<f64>()
        };
        let shifts: Vec<f64> = (0..40).map(|_| shift()).collect();
        let expected = 1.0 / 12.0_f64.sqrt();
        assert!(shifts.iter().all(|shift| (shift.abs() - expected).abs() < 1e-12), "{shifts:?}");
        assert!(shifts.iter().any(|&shift| shift > 0.0) && shifts.iter().any(|&shift| shift < 0.0));
    }
}
