//! Signals on one clock. Measured bags and simulations use the same type.

mod cylinder_signals;
mod denoise;
mod error;
mod interpolation;
mod noise;
mod pieces;
mod resolution;
mod sample;
mod slopes;
mod spikes;
mod standard_deviation;

pub use cylinder_signals::CylinderSignals;
pub use denoise::{denoised, denoised_towards_zero, noise_level};
pub use error::RecordingError;
pub(crate) use interpolation::without_holes;
pub use interpolation::{cubic, linear, zero_order_hold};
pub use noise::has_noise;
pub use pieces::{closed_gaps, longest_gap, median_interval};
pub use resolution::resolution;
pub use sample::{CylinderSample, Sample};
pub use slopes::slopes;
pub use spikes::spikes;
pub use standard_deviation::standard_deviation;

/// A recording of one machine: all signals sampled on one, possibly uneven, clock.
///
/// Every signal has one value per entry of [`Recording::time`]; `NaN` means "not measured". A signal that no
/// instrument measures at all is a vector of `NaN`. All quantities are SI: m, rad, s, N, Pa (gauge), m², m³/s;
/// oil temperature is in °C.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recording {
    /// Source of the signals, for the user: a bag's path or a simulated model's name.
    pub source: String,
    /// Timestamp of the first sample in nanoseconds since the Unix epoch.
    pub start_nanoseconds: i64,
    /// Sample times in s after the first sample, strictly increasing; the first entry is 0.
    pub time: Vec<f64>,
    /// One entry per hydraulic cylinder, in the order of the messages.
    pub cylinders: Vec<CylinderSignals>,
    /// Pump pressure pp in Pa (gauge).
    pub pump_pressure: Vec<f64>,
    /// Tank pressure pt in Pa (gauge).
    pub tank_pressure: Vec<f64>,
    /// Pump flow Qp in m³/s.
    pub pump_flow: Vec<f64>,
    /// Oil temperature in °C.
    pub oil_temperature: Vec<f64>,
}

impl Recording {
    /// An empty recording on the given clock (s, strictly increasing): every signal is `NaN`.
    ///
    /// ```
    /// use excavator_model::prelude::*;
    ///
    /// let time: Vec<f64> = (0..1000).map(|sample| f64::from(sample) * 1e-3).collect();
    /// let mut recording = Recording::unmeasured("by hand", time, &["arm"]);
    /// recording.cylinders[0].orifice_area.fill(5e-5); // m²
    /// recording.validate()?;
    /// assert!(recording.pump_pressure.iter().all(|pressure| pressure.is_nan()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn unmeasured(source: &str, time: Vec<f64>, cylinder_names: &[&str]) -> Self {
        let samples = time.len();
        let nothing = vec![f64::NAN; samples];
        Recording {
            source: source.to_string(),
            start_nanoseconds: 0,
            cylinders: cylinder_names.iter().map(|name| CylinderSignals::unmeasured(name, samples)).collect(),
            pump_pressure: nothing.clone(),
            tank_pressure: nothing.clone(),
            pump_flow: nothing.clone(),
            oil_temperature: nothing,
            time,
        }
    }

    /// Every `stride`-th sample of the recording.
    #[must_use]
    pub fn thinned(&self, stride: usize) -> Self {
        self.at(&(0..self.len()).step_by(stride.max(1)).collect::<Vec<usize>>())
    }

    /// Means of `count` samples each, time included: the recording at a lower rate, with less noise. Samples on both sides of
    /// a pause of the clock have no mean: `NaN`.
    #[must_use]
    pub fn averaged(&self, count: usize) -> Self {
        let count = count.max(1);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let mut other = self.with_columns(|column| column.chunks_exact(count).map(mean).collect());
        let time = other.time.clone();
        for pause in self.pieces().into_iter().map(|piece| piece.start).filter(|start| start % count != 0) {
            for column in other.columns_mut() {
                column.iter_mut().skip(pause / count).take(1).for_each(|value| *value = f64::NAN);
            }
        }
        other.time = time;
        other
    }

    /// The samples with these indices, which are in ascending order and below the recording's length.
    #[must_use]
    pub fn at(&self, samples: &[usize]) -> Self {
        self.with_columns(|column| samples.iter().map(|&sample| column[sample]).collect())
    }

    /// Applies `pick` to each column. A clone that is cut afterwards would keep the memory of the whole recording.
    fn with_columns(&self, pick: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        Recording {
            source: self.source.clone(),
            start_nanoseconds: self.start_nanoseconds,
            time: pick(&self.time),
            cylinders: self.cylinders.iter().map(|cylinder| cylinder.with_columns(&pick)).collect(),
            pump_pressure: pick(&self.pump_pressure),
            tank_pressure: pick(&self.tank_pressure),
            pump_flow: pick(&self.pump_flow),
            oil_temperature: pick(&self.oil_temperature),
        }
    }

    /// The recording at other times, s on its own clock: linear interpolation between samples, `NaN` outside.
    #[must_use]
    pub fn interpolated(&self, times: &[f64]) -> Self {
        let range = self.time.first().copied().unwrap_or(0.0)..=self.time.last().copied().unwrap_or(0.0);
        let at = |column: &[f64], time: f64| {
            if range.contains(&time) { linear(&self.time, column, time) } else { f64::NAN }
        };
        let mut other = self.with_columns(|column| times.iter().map(|&time| at(column, time)).collect());
        other.time = times.to_vec();
        other
    }

    /// The samples from `from` to `to`, s after the first; the first of them is time 0 of the part.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let (first, last) = (self.time.partition_point(|&t| t < from), self.time.partition_point(|&t| t <= to));
        let mut part = self.with_columns(|column| column.get(first..last).unwrap_or_default().to_vec());
        let start = part.time.first().copied().unwrap_or(0.0);
        part.time.iter_mut().for_each(|t| *t -= start);
        part.start_nanoseconds += (start * 1e9).round() as i64;
        part
    }

    /// The clock and every signal, for the same change to all of them sample by sample.
    pub fn columns_mut(&mut self) -> Vec<&mut Vec<f64>> {
        let own = [
            &mut self.time,
            &mut self.pump_pressure,
            &mut self.tank_pressure,
            &mut self.pump_flow,
            &mut self.oil_temperature,
        ];
        own.into_iter().chain(self.cylinders.iter_mut().flat_map(CylinderSignals::columns_mut)).collect()
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether the recording has no sample at all.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Time between the first and the last sample in s; 0 for fewer than two samples.
    pub fn duration(&self) -> f64 {
        match (self.time.first(), self.time.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    /// Median time between samples in s; `NaN` for fewer than two samples. The median, not the mean, because gaps from lost
    /// messages must not affect it.
    pub fn sample_interval(&self) -> f64 {
        median_interval(&self.time)
    }

    /// The signals of the cylinder with this name.
    ///
    /// # Errors
    /// [`RecordingError::UnknownCylinder`] with the existing names.
    pub fn cylinder(&self, name: &str) -> Result<&CylinderSignals, RecordingError> {
        self.cylinders.iter().find(|cylinder| cylinder.name == name).ok_or_else(|| RecordingError::UnknownCylinder {
            source_name: self.source.clone(),
            wanted: name.to_string(),
            found: self.cylinders.iter().map(|c| c.name.clone()).collect(),
        })
    }

    /// Checks the invariants of the fields: equal lengths and a strictly increasing, finite clock.
    ///
    /// # Errors
    /// [`RecordingError::LengthMismatch`] or [`RecordingError::ClockNotIncreasing`].
    pub fn validate(&self) -> Result<(), RecordingError> {
        for (name, signal) in self.signals() {
            if signal.len() != self.len() {
                return Err(RecordingError::LengthMismatch { signal: name, found: signal.len(), expected: self.len() });
            }
        }
        if let Some(&first) = self.time.first()
            && !first.is_finite()
        {
            return Err(RecordingError::ClockNotIncreasing { index: 0, previous: f64::NAN, next: first });
        }
        for (index, pair) in self.time.windows(2).enumerate() {
            if pair[1].partial_cmp(&pair[0]) != Some(std::cmp::Ordering::Greater) || !pair[1].is_finite() {
                return Err(RecordingError::ClockNotIncreasing { index: index + 1, previous: pair[0], next: pair[1] });
            }
        }
        Ok(())
    }

    /// Every signal with its contract name (`arm.displacement`, `pump_pressure`, ...), in a fixed order.
    pub fn signals(&self) -> Vec<(String, &[f64])> {
        let mut signals: Vec<(String, &[f64])> = Vec::new();
        for cylinder in &self.cylinders {
            for (name, values) in cylinder.signals() {
                signals.push((format!("{}.{name}", cylinder.name), values));
            }
        }
        signals.push(("pump_pressure".into(), &self.pump_pressure));
        signals.push(("tank_pressure".into(), &self.tank_pressure));
        signals.push(("pump_flow".into(), &self.pump_flow));
        signals.push(("oil_temperature".into(), &self.oil_temperature));
        signals
    }

    /// The signal with this contract name, `None` if there is no such name.
    pub fn signal(&self, name: &str) -> Option<&[f64]> {
        self.signals().into_iter().find(|(candidate, _)| candidate == name).map(|(_, values)| values)
    }
}

/// Whether at least one value of the signal was measured.
pub fn is_measured(signal: &[f64]) -> bool {
    signal.iter().any(|value| value.is_finite())
}
