//! Recordings cut into shooting segments.

use excavator_model::equations::System;
use excavator_model::recording::Recording;
use excavator_model::simulation::{InputSignals, initial_state};
use excavator_model::{Model, SignalError};

/// A recording with its inputs, cut into pieces that are simulated each from an own initial state.
#[derive(Debug, Clone)]
pub struct SegmentedRecording {
    /// The recording, thinned.
    pub recording: Recording,
    /// Inputs of the model on its clock.
    pub inputs: InputSignals,
    /// The pieces, in order.
    pub segments: Vec<Segment>,
}

/// Samples `first..=last` of a recording and the state at the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Index of the first sample.
    pub first: usize,
    /// Index of the last sample.
    pub last: usize,
    /// State at the first sample, in the order of the model's layout; improved by the fit.
    pub state: Vec<f64>,
}

/// A gap in the clock longer than this many sample intervals ends a segment: inputs inside it are unknown.
const LARGEST_GAP: f64 = 10.0;

/// Share of an opening that thinning may miss. A valve that follows its command through a servo of 12 ms loses 0.001 to 0.005 at
/// 170 Hz, which leaves a few hundredths of loss; one that jumps between two samples loses 0.05, and then the right model is
/// as far from the measurement as a wrong one.
const MOST_MISSED: f64 = 0.008;

/// Fewer samples than this say nothing beyond their own initial state.
const FEWEST_SAMPLES: usize = 20;

impl SegmentedRecording {
    /// Cuts `recording` into segments of about `duration` s, all of the same length, never across a gap of the clock,
    /// after thinning it to about `sample_rate` samples per second.
    ///
    /// # Errors
    /// [`SignalError`] when inputs or initial states are missing.
    pub fn new(model: &Model, recording: &Recording, duration: f64, sample_rate: f64) -> Result<Self, SignalError> {
        let stride = (1.0 / (recording.sample_interval() * sample_rate)).round().max(1.0);
        let stride = if stride.is_finite() { stride as usize } else { 1 };
        // Inputs are freed of noise at the full rate, then thinned.
        let full_inputs = InputSignals::from_recording(model, recording)?;
        let mut inputs = full_inputs.thinned(stride);
        let mut stride = stride;
        while stride > 1 && full_inputs.missed_by(&inputs, stride) > MOST_MISSED {
            stride -= 1;
            inputs = full_inputs.thinned(stride);
        }
        let full = recording;
        let recording = full.thinned(stride);
        let system = System::new(model);
        let interval = recording.sample_interval();
        let mut stretches = Vec::new();
        let mut first = 0;
        for index in 1..=recording.len() {
            let ends =
                index == recording.len() || recording.time[index] - recording.time[index - 1] > LARGEST_GAP * interval;
            if ends {
                stretches.push((first, index - 1));
                first = index;
            }
        }
        let mut segments = Vec::new();
        for (first, last) in stretches {
            let pieces = ((recording.time[last] - recording.time[first]) / duration).round().max(1.0) as usize;
            for piece in 0..pieces {
                let from = first + (last - first) * piece / pieces;
                let to = first + (last - first) * (piece + 1) / pieces;
                if to < from + FEWEST_SAMPLES {
                    continue;
                }
                let spool: Vec<f64> =
                    (0..model.machine.cylinders.len()).map(|c| inputs.orifice_area(c)[from]).collect();
                match initial_state(&system, full, from * stride, &spool, inputs.tank_pressure()[from]) {
                    Ok(state) => segments.push(Segment { first: from, last: to, state }),
                    // A segment that starts in a hole of the displacement cannot be simulated; the others can.
                    Err(SignalError::NoInitialState { .. }) => {}
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(SegmentedRecording { recording, inputs, segments })
    }
}
