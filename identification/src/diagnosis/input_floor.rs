//! What inputs that are known at samples only leave open.

use excavator_model::Model;
use excavator_model::equations::{Channel, System};
use excavator_model::recording::{Recording, noise_level};
use excavator_model::simulation::simulate;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::fit::{Fit, FitSettings, evaluate};

/// `fit`, with the noise of each instrument raised by what the sampling of the inputs leaves open on `recordings`.
///
/// When a valve moved between two samples nobody knows: anywhere in the interval, each time anew. How far outputs go wrong by
/// that is found by fitting the model to its own outputs for inputs that moved at other times within their intervals. A move
/// that goes on before and after an interval leaves little open: what one interval moves more than its neighbours counts.
/// `None` when that cannot be simulated.
pub(super) fn with_input_floor(fit: &Fit, recordings: &[&Recording], settings: &FitSettings) -> Option<Fit> {
    let disturbed: Option<Vec<Recording>> =
        recordings.iter().map(|recording| answer_to_other_moments(&fit.model, recording)).collect();
    let disturbed = disturbed?;
    let left = evaluate(&fit.model, &disturbed.iter().collect::<Vec<_>>(), settings).ok()?;
    let mut raised = fit.clone();
    for instrument in &mut raised.instruments {
        let position = left.instruments.iter().position(|own| own.name == instrument.name)?;
        instrument.noise = (instrument.noise.powi(2) + left.errors[position].powi(2)).sqrt();
    }
    Some(raised)
}

/// What the model's instruments report where inputs move at other moments of their intervals, beside the inputs as they are.
fn answer_to_other_moments(model: &Model, recording: &Recording) -> Option<Recording> {
    let simulated = simulate(model, &with_other_moments(model, recording)).ok()?;
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

fn with_other_moments(model: &Model, recording: &Recording) -> Recording {
    let mut moved = recording.clone();
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let mut moved_within = |signal: &mut Vec<f64>| *signal = moved_at_other_moments(signal, &mut random);
    let imposed = model.machine.has_imposed_motion();
    for cylinder in &mut moved.cylinders {
        moved_within(&mut cylinder.orifice_area);
        moved_within(&mut cylinder.orifice_command);
        if imposed {
            moved_within(&mut cylinder.displacement);
            moved_within(&mut cylinder.joint_angle);
        } else if !model.machine.has_chambers() {
            moved_within(&mut cylinder.rod_force);
        }
    }
    moved
}

/// Any: the same recordings get the same verdict.
const SEED: u64 = 1;

/// Noise levels below which a change of a signal is none.
const DOUBT: f64 = 5.0;

/// The signal where each move of one interval happened by half an interval over the square root of three, the standard deviation
/// of a moment that can be anywhere in it, sooner or later.
fn moved_at_other_moments(signal: &[f64], random: &mut ChaCha8Rng) -> Vec<f64> {
    let least = DOUBT * noise_level(signal);
    let change = |interval: usize| Some(signal.get(interval + 1)? - signal.get(interval)?);
    let mut moved = signal.to_vec();
    for interval in 0..signal.len().saturating_sub(1) {
        let Some(here) = change(interval) else { continue };
        let before = interval.checked_sub(1).and_then(change).unwrap_or(here);
        let after = change(interval + 1).unwrap_or(here);
        let more = if (here - before).abs() < (here - after).abs() { here - before } else { here - after };
        // A move that nobody measured both ends of is not known at all.
        if more.abs() > least {
            let by = 0.5 / 3.0_f64.sqrt() * more;
            if random.random() { moved[interval] += by } else { moved[interval + 1] -= by }
        }
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_may_have_happened_anywhere_in_its_interval_and_a_ramp_is_what_it_is() {
        let random = &mut ChaCha8Rng::seed_from_u64(3);
        let ramp: Vec<f64> = (0..50).map(|k| 0.2 * f64::from(k)).collect();
        assert!(ramp.iter().zip(moved_at_other_moments(&ramp, random)).all(|(a, b)| (a - b).abs() < 1e-12));

        let jump: Vec<f64> = (0..50).map(|k| f64::from(u8::from(k > 20))).collect();
        let shift = |moved: Vec<f64>| moved.iter().sum::<f64>() - jump.iter().sum::<f64>();
        let shifts: Vec<f64> = (0..40).map(|_| shift(moved_at_other_moments(&jump, random))).collect();
        let expected = 1.0 / 12.0_f64.sqrt();
        assert!(shifts.iter().all(|shift| (shift.abs() - expected).abs() < 1e-12), "{shifts:?}");
        assert!(shifts.iter().any(|&shift| shift > 0.0) && shifts.iter().any(|&shift| shift < 0.0));
    }
}
