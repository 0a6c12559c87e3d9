//! Simulates a recording with the model, piece by piece.

use excavator_model::equations::{Channel, System};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Integrator, Tolerances};
use excavator_model::{Imposed, Model};
use rayon::prelude::*;

use super::RegressionError;
use crate::fit::{FitSettings, SegmentedRecording};

/// A recording as the model would have produced it, simulated in pieces from measured states.
pub(super) struct Simulated {
    /// True values of the simulated signals, without instrument effects, at the recording's sample times. After an
    /// early end of a simulation they are those of the recording.
    pub recording: Recording,
    /// States of effects (a lagging spool), sample by sample.
    pub effect_states: Vec<Vec<f64>>,
}

/// Simulates `recording` with `model`. `truth` is the recording without the effects of the model's instruments.
///
/// # Errors
/// [`RegressionError`] if inputs or initial states are missing.
pub(super) fn simulated(model: &Model, recording: &Recording, truth: &Recording) -> Result<Simulated, RegressionError> {
    let system = System::new(model);
    // An imposed state does not drift, and a play remembers its last reversal.
    let duration = if model.imposed == Imposed::Everything {
        f64::INFINITY
    } else {
        FitSettings::default().segment_duration_for(&model.machine.size())
    };
    let segmented = SegmentedRecording::new(model, recording, duration, f64::INFINITY)?;
    let channels = Channel::all(system.layout());
    let own_states: usize = model.effects.iter().map(|effect| effect.physics.states()).sum();
    let parameters = model.parameter_values();
    let pieces: Vec<Piece> = segmented
        .segments
        .par_iter()
        .map(|segment| {
            let mut integrator = Integrator::new(&system, &parameters, &[], Tolerances::default());
            let mut state = segment.state.clone();
            let mut piece = Piece { first: segment.first, values: Vec::new(), effect_states: Vec::new() };
            for index in segment.first..=segment.last {
                piece.values.push(channels.iter().map(|channel| channel.value(&system, &state)).collect());
                piece.effect_states.push(state[state.len() - own_states..].to_vec());
                if index < segment.last && integrator.advance(&segmented.inputs, index, &mut state, None).is_err() {
                    // The rest of the segment keeps the measured values. They are worse instruments, but the rows stay
                    // valid.
                    break;
                }
            }
            piece
        })
        .collect();
    let mut copy = truth.clone();
    let mut effect_states = vec![vec![f64::NAN; own_states]; recording.len()];
    for Piece { first, values, effect_states: states } in pieces {
        for (number, channel) in channels.iter().enumerate() {
            if let Some(signal) = channel.signal_mut(&model.machine, &mut copy) {
                signal[first..].iter_mut().zip(&values).for_each(|(slot, values)| *slot = values[number]);
            }
        }
        effect_states[first..].iter_mut().zip(states).for_each(|(slot, states)| *slot = states);
    }
    Ok(Simulated { recording: copy, effect_states })
}

/// The simulation of one segment, sample by sample.
struct Piece {
    first: usize,
    /// Values of each channel.
    values: Vec<Vec<f64>>,
    effect_states: Vec<Vec<f64>>,
}
