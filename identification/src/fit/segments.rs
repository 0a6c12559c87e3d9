//! Recordings cut into shooting segments.

use excavator_model::effects::{Corner, Site};
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use excavator_model::simulation::{InputSignals, first_known_position, initial_state};
use excavator_model::{Model, SignalError};

/// A recording with its inputs, cut into pieces. Each is simulated from its own initial state.
#[derive(Debug, Clone)]
pub struct SegmentedRecording {
    /// The recording, thinned.
    pub recording: Recording,
    /// Whether the model is compared with each sample. The others are kept because an input changes slope there, or a
    /// piston arrives at a stop. All compared samples are equally spaced, so that all times have the same weight.
    pub compared: Vec<bool>,
    /// Inputs of the model at its sample times.
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
    /// State at the first sample, in the order of the model's layout. The fit improves it.
    pub state: Vec<f64>,
}

/// A time gap longer than this many sample intervals ends a segment, because inputs inside it are unknown.
const LARGEST_GAP: f64 = 10.0;

/// Fewer samples than this determine no more than their own initial state.
const FEWEST_SAMPLES: usize = 20;

/// Duration of an arrival, s, on a machine of the reference size: the bounce and the pressure shock in the oil.
const ARRIVAL: f64 = 0.3;

/// Whether a piston is arriving at a stop, sample by sample. The bounce depends on unknown contact properties. The
/// position and the pressures afterwards do tell something about the machine.
fn arrivals(model: &Model, recording: &Recording) -> Vec<bool> {
    let mut arriving = vec![false; recording.len()];
    let duration = ARRIVAL * model.machine.size().time();
    for (number, cylinder) in model.machine.cylinders.iter().enumerate() {
        let Ok(signals) = recording.cylinder(&cylinder.name) else { continue };
        if !model.has_corner(Corner::EndStop, Site::Cylinder(number)) {
            continue;
        }
        let (mut was_near, mut until) = (false, f64::NEG_INFINITY);
        for (sample, (&time, position)) in recording.time.iter().zip(&signals.displacement).enumerate() {
            if position.is_finite() {
                let is_near = cylinder.is_at_a_stop(*position);
                if is_near && !was_near {
                    until = time + duration;
                }
                was_near = is_near;
            }
            arriving[sample] |= time < until;
        }
    }
    arriving
}

impl SegmentedRecording {
    /// Thins `recording` to about `sample_rate` samples per second and cuts it into segments of about `duration` s.
    /// None crosses a gap in the sample times, and all between two gaps have the same length.
    ///
    /// # Errors
    /// [`SignalError`] if inputs or initial states are missing.
    pub fn new(model: &Model, recording: &Recording, duration: f64, sample_rate: f64) -> Result<Self, SignalError> {
        let stride = (1.0 / (recording.sample_interval() * sample_rate)).round().max(1.0);
        let stride = if stride.is_finite() { stride as usize } else { 1 };
        // Noise is removed from inputs at the full rate, before thinning.
        let full_inputs = InputSignals::from_recording(model, recording)?;
        let kept = full_inputs.needed_samples(stride);
        let inputs = full_inputs.at(&kept);
        let full = recording;
        let recording = full.at(&kept);
        let arriving = arrivals(model, full);
        let compared = kept.iter().map(|&sample| sample.is_multiple_of(stride) && !arriving[sample]).collect();
        let system = System::new(model);
        let interval = stride as f64 * full.sample_interval();
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
            let (begin, length) = (recording.time[first], recording.time[last] - recording.time[first]);
            let pieces = (length / duration).round().max(1.0) as usize;
            let end = |piece: usize| {
                let time = begin + length * piece as f64 / pieces as f64;
                recording.time.partition_point(|&sample| sample < time).clamp(first, last)
            };
            for piece in 0..pieces {
                let (from, to) = (end(piece), end(piece + 1));
                // A hole in a displacement at the start only moves the start to the end of the hole.
                let from = first_known_position(model, &recording, from).unwrap_or(from);
                if to < from + FEWEST_SAMPLES {
                    continue;
                }
                let spool: Vec<f64> =
                    (0..model.machine.cylinders.len()).map(|c| inputs.orifice_area(c)[from]).collect();
                match initial_state(&system, full, kept[from], &spool, inputs.tank_pressure()[from]) {
                    Ok(state) => segments.push(Segment { first: from, last: to, state }),
                    // A segment that starts in a hole of the displacement cannot be simulated. The others can.
                    Err(SignalError::NoInitialState { .. }) => {}
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(SegmentedRecording { recording, compared, inputs, segments })
    }
}
