//! From a clock and tracks to a recording.

use std::path::Path;

use excavator_model::recording::Recording;

use super::document::{Resampling, SignalSource};
use super::error::MapError;
use super::resample::{Policy, resample};
use super::signal::SignalKind;
use super::track::Track;
use crate::reading::{ReadReport, count_late, gaps, steps_back};

/// What was read for one signal.
pub(super) enum Samples {
    /// Values with their stamps, ns.
    Timed(Vec<(i64, f64)>),
    /// A constant, for the whole recording.
    Constant(f64),
}

/// Brings every signal onto the clock (stamps in ns, in the order of the data).
///
/// # Errors
/// [`MapError::EmptyClock`].
pub(super) fn assemble(
    source: &Path,
    clock_name: &str,
    mut stamps: Vec<i64>,
    signals: Vec<(&SignalSource, Samples)>,
    report: &mut ReadReport,
) -> Result<Recording, MapError> {
    report.reordered = count_late(&stamps);
    report.notes.extend(steps_back(&stamps));
    let count = stamps.len();
    stamps.sort_unstable();
    stamps.dedup();
    report.duplicates = (count - stamps.len()) as u64;
    let Some(&start) = stamps.first() else {
        return Err(MapError::EmptyClock { path: source.to_path_buf(), clock: clock_name.to_string() });
    };
    let time: Vec<f64> = stamps.iter().map(|&stamp| stamp.saturating_sub(start) as f64 / 1e9).collect();
    let mut recording = Recording::unmeasured(&source.display().to_string(), time, &[]);
    recording.start_nanoseconds = start;
    for (source, samples) in signals {
        let values = match samples {
            Samples::Constant(value) => vec![value; stamps.len()],
            Samples::Timed(samples) => {
                let track = Track::new(samples);
                let usual = if source.signal.kind == SignalKind::OrificeCommand {
                    Resampling::Hold
                } else {
                    Resampling::Linear
                };
                let policy = Policy::of(source.resample.unwrap_or(usual), source.maximum_gap, &track);
                let values = resample(&track, &stamps, policy);
                note_missing(&source.signal.to_string(), &track, &values, policy, report);
                values
            }
        };
        *source.signal.column(&mut recording) = values;
    }
    report.gaps = gaps(&recording);
    Ok(recording)
}

fn note_missing(signal: &str, track: &Track, values: &[f64], policy: Policy, report: &mut ReadReport) {
    let missing = values.iter().filter(|value| value.is_nan()).count();
    if track.is_empty() {
        report.notes.push(format!("{signal} was not measured: its source is in no message"));
    } else if missing > 0 {
        let limit = policy.maximum_gap / 1e9;
        let limit = if limit.is_finite() { format!(", or in gaps over {limit:.3} s") } else { String::new() };
        report.notes.push(format!(
            "{signal} has no value at {missing} of {} samples: before its first or after its last value{limit}",
            values.len()
        ));
    }
}
