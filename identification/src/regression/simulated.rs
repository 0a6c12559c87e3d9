//! A recording as the model would have produced it, piece by piece.

use excavator_model::Model;
use excavator_model::equations::{Channel, System};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Integrator, Tolerances};

use super::RegressionError;
use crate::fit::{FitSettings, SegmentedRecording};

/// A recording as the model would have produced it, simulated in pieces from measured states.
pub(super) struct Simulated {
    /// True values of the simulated signals, without what instruments make of them, on the recording's clock; as in the
    /// recording where a simulation ended early.
    pub recording: Recording,
    /// States of effects (a lagging spool), sample by sample.
    pub effect_states: Vec<Vec<f64>>,
}

/// Simulates `recording` with `model`. `truth` is the recording without what the model's instruments add.
///
/// # Errors
/// [`RegressionError`] when inputs or initial states are missing.
pub(super) fn simulated(model: &Model, recording: &Recording, truth: &Recording) -> Result<Simulated, RegressionError> {
    let system = System::new(model);
    let duration = FitSettings::default().segment_duration_for(&model.machine.size());
    let segmented = SegmentedRecording::new(model, recording, duration, f64::INFINITY)?;
    let mut copy = truth.clone();
    let channels = Channel::all(system.layout());
    let own_states: usize = model.effects.iter().map(|effect| effect.physics.states()).sum();
    let mut effect_states = vec![vec![f64::NAN; own_states]; recording.len()];
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &[], Tolerances::default());
    for segment in &segmented.segments {
        let mut state = segment.state.clone();
        for index in segment.first..=segment.last {
            for channel in &channels {
                if let Some(values) = channel.signal_mut(&model.machine, &mut copy) {
                    values[index] = channel.value(&system, &state);
                }
            }
            if let Some(slot) = effect_states.get_mut(index) {
                slot.copy_from_slice(&state[state.len() - own_states..]);
            }
            if index < segment.last && integrator.advance(&segmented.inputs, index, &mut state, None).is_err() {
                // The rest of the segment stays as measured: worse instruments, but still valid rows.
                break;
            }
        }
    }
    Ok(Simulated { recording: copy, effect_states })
}
