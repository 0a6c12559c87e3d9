//! Keeps the newest values of each signal, and decides whether they can be used.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use excavator_msgs::{ArmState, CylinderState, Header, Time};
use serde::Deserialize;

use super::limits::limits_of;

/// What becomes of the raw value of a signal.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Treatment {
    /// Which signal: `arm.displacement`, `pump_pressure`.
    pub signal: String,
    /// Factor of the raw value.
    #[serde(default = "one")]
    pub scale: f64,
    /// What is added to it then, in SI.
    #[serde(default)]
    pub offset: f64,
    /// Least value that can be, in SI; without: that of the kind of signal.
    pub minimum: Option<f64>,
    /// Largest value that can be, in SI; without: that of the kind of signal.
    pub maximum: Option<f64>,
    /// Age beyond which a value is of no use, s.
    #[serde(default = "default_age")]
    pub age: f64,
    /// How long ago a value was measured when it comes: filter of the sensor, its sampling, its way here, s.
    #[serde(default)]
    pub delay: f64,
}

/// Values kept of each signal: more than a second at the highest rate.
const KEPT: usize = 4096;
/// Longest delay of a signal, s.
const LONGEST_DELAY: f64 = 1.0;

fn one() -> f64 {
    1.0
}

/// 0.1 s: ten samples of a slow instrument.
fn default_age() -> f64 {
    0.1
}

pub(super) const OF_CYLINDERS: [&str; 7] =
    ["joint_angle", "displacement", "velocity", "cap_pressure", "rod_pressure", "orifice_area", "rod_force"];
pub(super) const OF_MACHINE: [&str; 4] = ["pump_pressure", "tank_pressure", "pump_flow", "oil_temperature"];

impl Treatment {
    /// Checks that the treatment is consistent.
    ///
    /// # Errors
    /// What is wrong, in one line.
    pub fn check(&self) -> Result<(), String> {
        let known = match self.signal.split_once('.') {
            Some((cylinder, name)) => !cylinder.is_empty() && OF_CYLINDERS.contains(&name),
            None => OF_MACHINE.contains(&self.signal.as_str()),
        };
        if !known {
            return Err(format!(
                "there is no signal \"{}\"; there are CYLINDER.{} and {}",
                self.signal,
                OF_CYLINDERS.join(", CYLINDER."),
                OF_MACHINE.join(", ")
            ));
        }
        if !self.scale.is_finite() || self.scale == 0.0 || !self.offset.is_finite() {
            return Err(format!("{}: scale {} and offset {} make no value", self.signal, self.scale, self.offset));
        }
        let (minimum, maximum) = self.range();
        if minimum.is_nan() || maximum.is_nan() || minimum >= maximum {
            return Err(format!("{}: nothing is between {minimum} and {maximum}", self.signal));
        }
        if !(self.age > 0.0 && self.age < 1e6) {
            return Err(format!("{}: an age of {} s makes no sense", self.signal, self.age));
        }
        if !(0.0..=LONGEST_DELAY).contains(&self.delay) {
            return Err(format!("{}: a delay of {} s is outside 0 to {LONGEST_DELAY}", self.signal, self.delay));
        }
        Ok(())
    }
}

impl Treatment {
    /// Least and largest possible value, in SI.
    pub fn range(&self) -> (f64, f64) {
        let (least, largest) = limits_of(&self.signal);
        (self.minimum.unwrap_or(least), self.maximum.unwrap_or(largest))
    }

    /// Converts a raw value to SI.
    fn value(&self, raw: f64) -> Result<f64, Fault> {
        let value = raw * self.scale + self.offset;
        let (minimum, maximum) = self.range();
        if !value.is_finite() || value < minimum || value > maximum {
            return Err(Fault::OutOfRange(value));
        }
        Ok(value)
    }

    /// Narrows the range to raw values from `least` to `largest`.
    #[cfg(feature = "can")]
    pub fn narrow(&mut self, least: f64, largest: f64) {
        let (one, other) = (least * self.scale + self.offset, largest * self.scale + self.offset);
        let (minimum, maximum) = self.range();
        self.minimum = Some(minimum.max(one.min(other)));
        self.maximum = Some(maximum.min(one.max(other)));
    }

    /// Whether the signal changes in steps.
    fn steps(&self) -> bool {
        self.signal.ends_with(".orifice_area")
    }
}

fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value).unwrap_or(Duration::ZERO)
}

/// Why a signal is not measured.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Fault {
    /// No value has arrived yet.
    Never,
    /// The last value is too old, s.
    Stale(f64),
    /// The last value is outside its range.
    OutOfRange(f64),
}

/// The last values of each signal, resampled onto one clock.
///
/// The state belongs to the moment for which the slowest signal has a value, which lies in the past by the longest delay. The
/// other signals are interpolated linearly to that moment. An orifice area, which changes in steps, keeps its value until the
/// next measurement.
#[derive(Debug)]
pub(super) struct Signals {
    treatments: Vec<Treatment>,
    /// Raw values and their measurement times, oldest first.
    values: Vec<VecDeque<(f64, Instant)>>,
    delay: Duration,
}

impl Signals {
    /// Signals without any values yet.
    pub fn new(treatments: Vec<Treatment>) -> Self {
        let values = vec![VecDeque::new(); treatments.len()];
        let delay = treatments.iter().map(|treatment| treatment.delay).fold(0.0, f64::max);
        Signals { treatments, values, delay: seconds(delay) }
    }

    /// The time by which the state lies in the past.
    pub fn delay(&self) -> Duration {
        self.delay
    }

    /// Takes a raw value that arrived at `now`. A value that was measured before the last one is late and is dropped.
    pub fn take(&mut self, index: usize, raw: f64, now: Instant) {
        let (Some(treatment), Some(values)) = (self.treatments.get(index), self.values.get_mut(index)) else { return };
        let measured = now.checked_sub(seconds(treatment.delay)).unwrap_or(now);
        if values.back().is_some_and(|(_, last)| *last > measured) {
            return;
        }
        if values.len() >= KEPT {
            values.pop_front();
        }
        values.push_back((raw, measured));
    }

    /// The value in SI, at `now` less the common delay.
    ///
    /// # Errors
    /// [`Fault`] if it is not measured.
    pub fn value(&self, index: usize, now: Instant) -> Result<f64, Fault> {
        let moment = now.checked_sub(self.delay).unwrap_or(now);
        let (treatment, values) = (&self.treatments[index], &self.values[index]);
        let after = values.partition_point(|(_, at)| *at <= moment);
        let Some((raw, at)) = after.checked_sub(1).map(|before| values[before]) else {
            return Err(Fault::Never);
        };
        let age = moment.saturating_duration_since(at);
        if age > seconds(treatment.age) {
            return Err(Fault::Stale(age.as_secs_f64()));
        }
        let value = treatment.value(raw)?;
        let Some((next, next_at)) = values.get(after).copied() else { return Ok(value) };
        let gap = next_at.saturating_duration_since(at);
        match treatment.value(next) {
            Ok(next) if !treatment.steps() && gap <= seconds(treatment.age) && !gap.is_zero() => {
                Ok(value + (next - value) * (age.as_secs_f64() / gap.as_secs_f64()))
            }
            _ => Ok(value),
        }
    }

    /// Drops values that no later state can need.
    fn forget(&mut self, now: Instant) {
        let moment = now.checked_sub(self.delay).unwrap_or(now);
        for values in &mut self.values {
            while values.get(1).is_some_and(|(_, at)| *at <= moment) {
                values.pop_front();
            }
        }
    }

    /// Name of a signal.
    pub fn name(&self, index: usize) -> &str {
        &self.treatments[index].signal
    }

    /// The state at `now` less the common delay, with the given `stamp`, and the signals that are not measured, with the
    /// reason.
    pub fn state(&mut self, stamp: Time, now: Instant) -> (ArmState, Vec<(usize, Fault)>) {
        let mut state = ArmState {
            header: Header { stamp, frame_id: String::new() },
            cylinders: Vec::new(),
            pump_pressure: f64::NAN,
            tank_pressure: f64::NAN,
            pump_flow: f64::NAN,
            oil_temperature: f64::NAN,
        };
        let mut faults = Vec::new();
        self.forget(now);
        for (index, treatment) in self.treatments.iter().enumerate() {
            let value = self.value(index, now).unwrap_or_else(|fault| {
                faults.push((index, fault));
                f64::NAN
            });
            if let Some(slot) = slot(&mut state, &treatment.signal) {
                *slot = value;
            }
        }
        (state, faults)
    }
}

/// The field of a signal in the message. Adds the signal's cylinder if it is new.
fn slot<'s>(state: &'s mut ArmState, signal: &str) -> Option<&'s mut f64> {
    let Some((name, field)) = signal.split_once('.') else {
        return match signal {
            "pump_pressure" => Some(&mut state.pump_pressure),
            "tank_pressure" => Some(&mut state.tank_pressure),
            "pump_flow" => Some(&mut state.pump_flow),
            "oil_temperature" => Some(&mut state.oil_temperature),
            _ => None,
        };
    };
    if !state.cylinders.iter().any(|cylinder| cylinder.name == name) {
        state.cylinders.push(CylinderState::unmeasured(name));
    }
    let cylinder = state.cylinders.iter_mut().find(|cylinder| cylinder.name == name)?;
    match field {
        "joint_angle" => Some(&mut cylinder.joint_angle),
        "displacement" => Some(&mut cylinder.displacement),
        "velocity" => Some(&mut cylinder.velocity),
        "cap_pressure" => Some(&mut cylinder.cap_pressure),
        "rod_pressure" => Some(&mut cylinder.rod_pressure),
        "orifice_area" => Some(&mut cylinder.orifice_area),
        "rod_force" => Some(&mut cylinder.rod_force),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn treatment(signal: &str) -> Treatment {
        Treatment {
            signal: signal.into(),
            scale: 1e-3,
            offset: -0.3,
            minimum: Some(-0.31),
            maximum: Some(0.31),
            age: 0.05,
            delay: 0.0,
        }
    }

    #[test]
    fn a_value_is_scaled_and_ages() {
        let start = Instant::now();
        let mut signals = Signals::new(vec![treatment("arm.displacement"), treatment("boom.displacement")]);
        signals.take(0, 400.0, start);
        let (state, faults) = signals.state(Time::default(), start);
        assert!((state.cylinders[0].displacement - 0.1).abs() < 1e-12);
        assert_eq!(faults, [(1, Fault::Never)]);
        let later = start + Duration::from_millis(51);
        assert!(matches!(signals.value(0, later), Err(Fault::Stale(age)) if age > 0.05));
        assert!(signals.state(Time::default(), later).0.cylinders[0].displacement.is_nan());
    }

    #[test]
    fn what_cannot_be_is_not_measured() {
        let start = Instant::now();
        let mut signals = Signals::new(vec![treatment("arm.displacement")]);
        for raw in [1e6, f64::NAN, f64::INFINITY] {
            signals.take(0, raw, start);
            assert!(matches!(signals.value(0, start), Err(Fault::OutOfRange(_))), "{raw}");
        }
    }

    #[test]
    fn without_limits_of_its_own_a_signal_has_those_of_its_kind() {
        let start = Instant::now();
        let own =
            |signal: &str| Treatment { scale: 1.0, offset: 0.0, minimum: None, maximum: None, ..treatment(signal) };
        let wider = Treatment { maximum: Some(2e8), ..own("boom.cap_pressure") };
        let mut signals = Signals::new(vec![own("arm.cap_pressure"), wider]);
        for (raw, fits) in [(3e7, true), (1.5e8, false), (1e30, false), (-5e5, false)] {
            signals.take(0, raw, start);
            assert_eq!(signals.value(0, start).is_ok(), fits, "{raw}");
        }
        signals.take(1, 1.5e8, start);
        assert!(signals.value(1, start).is_ok());
    }

    #[test]
    fn signals_with_different_delays_are_brought_onto_one_clock() {
        let start = Instant::now();
        let ms = |count: u64| start + Duration::from_millis(count);
        let slow = Treatment { delay: 0.03, ..treatment("boom.displacement") };
        let steps = Treatment { minimum: Some(-1.0), maximum: Some(1.0), ..treatment("arm.orifice_area") };
        let mut signals = Signals::new(vec![treatment("arm.displacement"), slow, steps]);
        assert_eq!(signals.delay(), Duration::from_millis(30));
        // All move by one millimetre per millisecond; the slow signal arrives 30 ms late.
        for now in (0..=100).step_by(20) {
            signals.take(0, 300.0 + now as f64, ms(now));
            signals.take(1, 300.0 + now as f64 - 30.0, ms(now));
            signals.take(2, 300.0 + now as f64, ms(now));
        }
        let (state, faults) = signals.state(Time::default(), ms(100));
        assert_eq!(faults, []);
        assert!((state.cylinders[0].displacement - 0.07).abs() < 1e-9, "{}", state.cylinders[0].displacement);
        assert!((state.cylinders[1].displacement - 0.07).abs() < 1e-9, "{}", state.cylinders[1].displacement);
        assert!((state.cylinders[0].orifice_area - 0.06).abs() < 1e-9);
    }

    #[test]
    fn a_late_value_is_not_taken() {
        let start = Instant::now();
        let later = start + Duration::from_millis(10);
        let mut signals = Signals::new(vec![treatment("arm.displacement")]);
        signals.take(0, 400.0, later);
        signals.take(0, 500.0, start);
        assert_eq!(signals.value(0, later).map(|value| (value * 1e3).round()), Ok(100.0));
    }

    #[test]
    fn a_range_is_narrowed_through_a_negative_scale() {
        let mut narrowed = Treatment { scale: -1e-3, offset: 0.0, ..treatment("arm.displacement") };
        narrowed.narrow(-100.0, 200.0);
        assert_eq!(narrowed.range(), (-0.2, 0.1));
    }
}
