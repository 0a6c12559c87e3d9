//! Command profiles: orifice areas as functions of time.

use serde::{Deserialize, Serialize};

use crate::recording::Recording;

/// An invalid command profile.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// A number of the profile is out of range.
    #[error("profile: {quantity} = {value} must be {must}")]
    Impossible {
        /// Name of the number.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// Its permitted range.
        must: &'static str,
    },
    /// A profile has no segments.
    #[error("profile: {cylinder} has no segments; give it some, or leave its profile out and it stays closed")]
    Empty {
        /// The cylinder.
        cylinder: String,
    },
}

/// Orifice area commanded to one cylinder: segments one after the other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// The cylinder.
    pub cylinder: String,
    /// What it is asked to do, in order; closed afterwards.
    pub segments: Vec<Segment>,
}

/// One piece of a profile. Times in s, areas in m² (+ = pump to cap side), frequencies in Hz.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Segment {
    /// `amplitude sin(2 pi frequency t)`.
    Sine {
        /// Length, s.
        duration: f64,
        /// m².
        amplitude: f64,
        /// Hz.
        frequency: f64,
    },
    /// A sine whose frequency runs from one value to another at a constant rate.
    Sweep {
        /// Length, s.
        duration: f64,
        /// m².
        amplitude: f64,
        /// Hz at the start.
        from_frequency: f64,
        /// Hz at the end.
        to_frequency: f64,
    },
    /// Up in `ramp` seconds, held, down in `ramp` seconds.
    Trapezoid {
        /// Whole length, s.
        duration: f64,
        /// m².
        amplitude: f64,
        /// s.
        ramp: f64,
    },
    /// A constant area.
    Hold {
        /// Length, s.
        duration: f64,
        /// m².
        area: f64,
    },
}

impl Segment {
    /// Length in s.
    pub fn duration(&self) -> f64 {
        match *self {
            Segment::Sine { duration, .. }
            | Segment::Sweep { duration, .. }
            | Segment::Trapezoid { duration, .. }
            | Segment::Hold { duration, .. } => duration,
        }
    }

    /// Area at `time` s after the segment's start, m².
    pub fn area(&self, time: f64) -> f64 {
        let turn = std::f64::consts::TAU;
        match *self {
            Segment::Sine { amplitude, frequency, .. } => amplitude * (turn * frequency * time).sin(),
            Segment::Sweep { duration, amplitude, from_frequency, to_frequency } => {
                let phase = from_frequency * time + (to_frequency - from_frequency) * time * time / (2.0 * duration);
                amplitude * (turn * phase).sin()
            }
            Segment::Trapezoid { duration, amplitude, ramp } => {
                amplitude * (time / ramp).min((duration - time) / ramp).clamp(0.0, 1.0)
            }
            Segment::Hold { area, .. } => area,
        }
    }

    /// The largest frequency, Hz; zero for a segment without one.
    pub fn largest_frequency(&self) -> f64 {
        match *self {
            Segment::Sine { frequency, .. } => frequency,
            Segment::Sweep { from_frequency, to_frequency, .. } => from_frequency.max(to_frequency),
            Segment::Trapezoid { .. } | Segment::Hold { .. } => 0.0,
        }
    }

    /// The largest absolute area, m².
    pub fn largest_area(&self) -> f64 {
        match *self {
            Segment::Sine { amplitude, .. }
            | Segment::Sweep { amplitude, .. }
            | Segment::Trapezoid { amplitude, .. } => amplitude.abs(),
            Segment::Hold { area, .. } => area.abs(),
        }
    }

    fn check(&self) -> Result<(), ProfileError> {
        let must = |is_so: bool, quantity, value: f64, must| {
            if is_so { Ok(()) } else { Err(ProfileError::Impossible { quantity, value, must }) }
        };
        let positive =
            |quantity, value: f64| must(value.is_finite() && value > 0.0, quantity, value, "a positive number");
        positive("duration", self.duration())?;
        must(self.largest_area().is_finite(), "area or amplitude", self.largest_area(), "a finite number of m2")?;
        match *self {
            Segment::Trapezoid { ramp, duration, .. } => {
                positive("ramp", ramp)?;
                must(2.0 * ramp <= duration * (1.0 + 1e-9), "ramp", ramp, "at most half of the segment's duration")
            }
            Segment::Sine { frequency, .. } => positive("frequency", frequency),
            Segment::Sweep { from_frequency, to_frequency, .. } => {
                let zero_or_more = |value: f64| value.is_finite() && value >= 0.0;
                must(zero_or_more(from_frequency), "from_frequency", from_frequency, "zero or a positive number")?;
                must(zero_or_more(to_frequency), "to_frequency", to_frequency, "zero or a positive number")
            }
            Segment::Hold { .. } => Ok(()),
        }
    }
}

impl Profile {
    /// Commands each cylinder of a recording with its own profile from the first sample on. The valves follow exactly;
    /// cylinders without a profile stay closed. No force acts on any rod.
    ///
    /// ```
    /// use excavator_model::prelude::*;
    ///
    /// let segments = vec![Segment::Sine { duration: 2.0, amplitude: 8e-5, frequency: 0.5 }];
    /// let profile = Profile { cylinder: "arm".into(), segments };
    /// profile.check()?;
    /// let time: Vec<f64> = (0..=2000).map(|sample| f64::from(sample) * 1e-3).collect();
    /// let mut recording = Recording::unmeasured("sine", time, &["arm"]);
    /// Profile::command(&[profile], &mut recording);
    /// let opening = recording.cylinders[0].orifice_area[500]; // at 0.5 s, m²
    /// assert!((opening - 8e-5).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn command(profiles: &[Profile], recording: &mut Recording) {
        let start = recording.time.first().copied().unwrap_or(0.0);
        for signals in &mut recording.cylinders {
            let own = profiles.iter().find(|profile| profile.cylinder == signals.name);
            for (index, &time) in recording.time.iter().enumerate() {
                let area = own.map_or(0.0, |profile| profile.area(time - start));
                signals.orifice_area[index] = area;
                signals.orifice_command[index] = area;
                signals.rod_force[index] = 0.0;
            }
        }
    }

    /// Total length in s.
    pub fn duration(&self) -> f64 {
        self.segments.iter().map(Segment::duration).sum()
    }

    /// Area at `time` s, m²; zero outside.
    pub fn area(&self, time: f64) -> f64 {
        let mut start = 0.0;
        for segment in &self.segments {
            if time >= start && time < start + segment.duration() {
                return segment.area(time - start);
            }
            start += segment.duration();
        }
        0.0
    }

    /// Checks that every number is valid.
    ///
    /// # Errors
    /// [`ProfileError::Impossible`], and [`ProfileError::Empty`] for a profile without segments.
    pub fn check(&self) -> Result<(), ProfileError> {
        if self.segments.is_empty() {
            return Err(ProfileError::Empty { cylinder: self.cylinder.clone() });
        }
        self.segments.iter().try_for_each(Segment::check)
    }
}
