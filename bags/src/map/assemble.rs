//! Assembles a recording from a clock and tracks.

use std::path::Path;

use excavator_model::recording::Recording;

use super::conversion::Conversion;
use super::document::TopicMap;
use super::error::MapError;
use super::fault_code;
use super::least_delays::stretch_text;
use super::resample::{Policy, resample};
use super::signal_source::SignalSource;
use super::spike_line::spike_line;
use super::track::Track;
use super::traps::{Readings, traps};
use super::unit::Dimension;
use super::wanted::{Computed, Wanted};
use crate::reading::{MappedUnit, ReadReport, count_late, gaps, steps_back};

/// A sensor may end this long before the clock begins, ns; more is another clock.
const ENDS_EARLY: i64 = 1_000_000_000;

/// The numbers of one signal or name.
enum Samples {
    /// Before their conversion, with their stamps, ns.
    Timed(Vec<(i64, f64)>),
    /// A constant, for the whole recording.
    Constant(f64),
}

/// A signal or name with its samples.
pub(super) struct Input<'m> {
    label: String,
    signal: Option<&'m SignalSource>,
    /// How it is resampled to the clock; `None` for a constant.
    wanted: Option<(Wanted<'m>, Conversion)>,
    samples: Samples,
}

impl<'m> Input<'m> {
    /// The numbers of an entry of the map with their stamps, ns, before their conversion.
    pub fn read(wanted: Wanted<'m>, conversion: Conversion, samples: Vec<(i64, f64)>) -> Input<'m> {
        let (label, signal) = (wanted.label.clone(), wanted.signal);
        Input { label, signal, wanted: Some((wanted, conversion)), samples: Samples::Timed(samples) }
    }

    /// The signal and what its values measure, if the map or the data say so.
    fn mapped(&self) -> Option<MappedUnit> {
        let (_, conversion) = self.wanted.as_ref()?;
        mapped_unit(self.signal?, conversion)
    }

    /// What its values measure; `None` for a constant of the map, and for a name without unit.
    fn dimension(&self) -> Option<Dimension> {
        let (_, conversion) = self.wanted.as_ref()?;
        match self.signal {
            Some(source) => Some(source.signal.kind.dimension()),
            None => conversion.measures().map(|(dimension, _)| dimension),
        }
    }

    /// Its values at the clock times (ns, ascending).
    ///
    /// # Errors
    /// [`MapError::NoCommonTime`].
    fn on(self, clock: &[i64], clock_name: &str, report: &mut ReadReport) -> Result<Vec<f64>, MapError> {
        let (mut samples, (wanted, conversion)) = match (self.samples, self.wanted) {
            (Samples::Constant(value), _) => return Ok(vec![value; clock.len()]),
            (Samples::Timed(_), None) => return Ok(vec![f64::NAN; clock.len()]),
            (Samples::Timed(samples), Some(wanted)) => (samples, wanted),
        };
        let codes = fault_code::remove(&mut samples);
        samples.iter_mut().for_each(|(_, number)| *number = conversion.apply(*number));
        let mut track = Track::new(samples);
        report.notes.extend(fault_code::note(&self.label, &codes, &track));
        if wanted.from.topic.is_some() {
            check_common_time(&self.label, &track, clock, clock_name)?;
        }
        let policy = Policy::of(wanted.resampling(), wanted.from.maximum_gap, &track);
        note_differing(&self.label, &track, wanted.from.topic.as_deref(), report);
        if let Some(source) = self.signal {
            leave_out_spikes(source, &mut track, clock, report);
        }
        let values = resample(&track, clock, policy);
        note_missing(&self.label, &track, &values, policy, report);
        Ok(values)
    }
}

/// Signals whose value is a constant in the map.
///
/// # Errors
/// [`MapError::BadQuantity`], [`MapError::BadNumber`].
pub(super) fn constants(map: &TopicMap) -> Result<Vec<Input<'_>>, MapError> {
    let mut constants = Vec::new();
    for source in &map.signals {
        if let Some(value) = &source.value {
            let label = source.signal.to_string();
            let value = value.to_si(&label, "value", source.signal.kind.dimension())?;
            constants.push(Input { label, signal: Some(source), wanted: None, samples: Samples::Constant(value) });
        }
    }
    Ok(constants)
}

/// Resamples all inputs to the clock (stamps in ns, in the order of the data), and evaluates the formulas of the map.
///
/// # Errors
/// [`MapError::EmptyClock`], [`MapError::NoCommonTime`].
pub(super) fn assemble(
    path: &Path,
    clock_name: &str,
    mut stamps: Vec<i64>,
    map: &TopicMap,
    inputs: Vec<Input>,
    computed: &[Computed],
    report: &mut ReadReport,
) -> Result<Recording, MapError> {
    report.reordered = count_late(&stamps);
    report.notes.extend(steps_back(&stamps));
    let count = stamps.len();
    stamps.sort_unstable();
    stamps.dedup();
    report.duplicates = (count - stamps.len()) as u64;
    let Some(&start) = stamps.first() else {
        return Err(MapError::EmptyClock { path: path.to_path_buf(), clock: clock_name.to_string() });
    };
    let time: Vec<f64> = stamps.iter().map(|&stamp| stamp.saturating_sub(start) as f64 / 1e9).collect();
    let mut recording = Recording::unmeasured(&path.display().to_string(), time, &[]);
    recording.start_nanoseconds = start;
    // Cylinders are in the order of the map.
    for source in &map.signals {
        source.signal.column(&mut recording);
    }
    let is_used = |label: &str| computed.iter().any(|computed| computed.inputs.iter().any(|input| input == label));
    let mut used: Vec<(String, Vec<f64>)> = Vec::new();
    let mut dimensions: Vec<(String, Option<Dimension>)> = Vec::new();
    for input in inputs {
        let (label, signal, dimension) = (input.label.clone(), input.signal, input.dimension());
        // A constant of the map is no reading.
        let is_read = input.wanted.is_some();
        let is_used = is_used(&label);
        report.mapped.extend(input.mapped());
        if signal.is_none() && !is_used {
            continue;
        }
        let values = input.on(&stamps, clock_name, report)?;
        if is_read {
            dimensions.push((label.clone(), dimension));
        }
        if is_used {
            used.push((label, values.clone()));
        }
        if let Some(source) = signal {
            *source.signal.column(&mut recording) = values;
        }
    }
    report.notes.extend(odd_readings(&recording, &used, &dimensions));
    for Computed { source, formula, inputs, conversion } in computed {
        // Names of the map are added after signals, and take precedence over signals of the same name.
        let column =
            |label: &String| used.iter().rfind(|(known, _)| known == label).map_or(&[][..], |(_, values)| values);
        report.mapped.extend(mapped_unit(source, conversion));
        let columns: Vec<&[f64]> = inputs.iter().map(column).collect();
        let values = formula.evaluate(&recording.time, &columns);
        let values: Vec<f64> = values.into_iter().map(|value| conversion.apply(value)).collect();
        let missing = values.iter().filter(|value| value.is_nan()).count();
        if missing > 0 {
            let (signal, samples) = (&source.signal, values.len());
            report
                .notes
                .push(format!("{signal} has no value at {missing} of {samples} samples: its formula has none there"));
        }
        *source.signal.column(&mut recording) = values;
    }
    report.gaps = gaps(&recording);
    Ok(recording)
}

/// What is odd about the signals and names that were read.
fn odd_readings(
    recording: &Recording,
    used: &[(String, Vec<f64>)],
    dimensions: &[(String, Option<Dimension>)],
) -> Vec<String> {
    let signals = recording.signals();
    let of = |(label, dimension): &(String, Option<Dimension>)| {
        let named = used.iter().find(|(known, _)| known == label).map(|(_, values)| &values[..]);
        let values = named.or_else(|| signals.iter().find(|(name, _)| name == label).map(|(_, values)| *values))?;
        Some(Readings { label: label.clone(), dimension: *dimension, values })
    };
    traps(&dimensions.iter().filter_map(of).collect::<Vec<_>>())
}

/// Values stamped by another clock than the samples are in none of them.
fn check_common_time(signal: &str, track: &Track, clock: &[i64], clock_name: &str) -> Result<(), MapError> {
    let (Some((first, last)), Some((&start, &end))) = (track.range(), clock.first().zip(clock.last())) else {
        return Ok(());
    };
    let length = end.saturating_sub(start);
    let distance = first.saturating_sub(end).max(start.saturating_sub(last));
    if distance <= length.saturating_add(ENDS_EARLY) {
        return Ok(());
    }
    let stretch = stretch_text(first.saturating_sub(start), last.saturating_sub(start));
    let (signal, clock, duration) = (signal.to_string(), clock_name.to_string(), length as f64 / 1e9);
    Err(MapError::NoCommonTime { signal, clock, stretch, duration })
}

fn note_differing(signal: &str, track: &Track, topic: Option<&str>, report: &mut ReadReport) {
    if track.differing() > 0 {
        let hint = topic.map_or(String::new(), |topic| format!("; perhaps two publishers write {topic}"));
        report.notes.push(format!(
            "{signal}: {} values differ from an earlier one with the same time; the earlier one is used{hint}",
            track.differing()
        ));
    }
}

/// Leaves out single values that no machine can reach between two samples.
fn leave_out_spikes(source: &SignalSource, track: &mut Track, clock: &[i64], report: &mut ReadReport) {
    let Some(longest) = source.signal.kind.calm_interval() else { return };
    let found = track.leave_out_spikes(longest * 1e9);
    let Some(&(first, value)) = found.first() else { return };
    let start = clock.first().copied().unwrap_or_default();
    let at = first.saturating_sub(start) as f64 / 1e9;
    report.notes.push(spike_line(&source.signal, found.len(), at, value));
}

fn mapped_unit(source: &SignalSource, conversion: &Conversion) -> Option<MappedUnit> {
    let (dimension, unit) = conversion.measures()?;
    Some(MappedUnit { signal: source.signal.clone(), unit, dimension })
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
