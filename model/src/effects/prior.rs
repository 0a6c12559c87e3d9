//! Priors of nuisance parameters, before a recording is read.

use crate::display::pressure_text;

/// A normal distribution of a nuisance parameter about the value at which its effect has no influence: its first start value.
///
/// A nuisance parameter describes the recording or the rounding of a corner in the equations. It is estimated with every model.
/// The prior keeps it from replacing a property of the machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// One standard deviation.
    pub spread: Spread,
    /// Scale on which the distribution is normal.
    pub scale: PriorScale,
    /// Permitted deviation from the centre in standard deviations, below (negative) and above. A larger deviation is not a
    /// nuisance: it has a cause that a diagnosis should find.
    pub range: [f64; 2],
}

/// Report text for a nuisance effect with a significant estimate.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// A sentence without its full stop, for one place and for several.
    pub sentences: [&'static str; 2],
    /// The estimate in engineering units, to follow "that of the arm".
    pub value: String,
}

/// Scale on which a [`Prior`] is normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PriorScale {
    /// The parameter itself; the spread is in its unit.
    Linear,
    /// The logarithm of a parameter above zero; the spread is a factor above one.
    Logarithmic,
}

/// One standard deviation of a [`Prior`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// The same for every recording: in the parameter's unit, or a factor on the logarithmic scale.
    Fixed(f64),
    /// A fraction of the longest sample interval, but at least this many seconds.
    OfSampleInterval {
        /// Fraction of the sample interval, a pure number.
        part: f64,
        /// Least spread, s.
        at_least_s: f64,
    },
    /// A fraction of the largest opening in the recordings at the effect's site.
    OfLargestOpening {
        /// Fraction of the opening, a pure number.
        part: f64,
    },
}

/// Scales of a fit's recordings, for the spreads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordingScales {
    /// Longest sample interval of the recordings, s.
    pub sample_interval_s: f64,
    /// Largest absolute opening at the effect's site, m².
    pub largest_opening_m2: f64,
}

impl Prior {
    /// The same for a parameter scaled by `factor`.
    pub(super) fn grown(self, factor: f64) -> Self {
        match (self.spread, self.scale) {
            (Spread::Fixed(spread), PriorScale::Linear) => Prior { spread: Spread::Fixed(spread * factor), ..self },
            _ => self,
        }
    }

    /// One standard deviation for recordings of these scales: in the parameter's unit, or a factor on the logarithmic scale.
    pub fn standard_deviation(&self, scales: &RecordingScales) -> f64 {
        match self.spread {
            Spread::Fixed(spread) => spread,
            Spread::OfSampleInterval { part, at_least_s } => (part * scales.sample_interval_s).max(at_least_s),
            Spread::OfLargestOpening { part } => part * scales.largest_opening_m2,
        }
    }

    /// Least and largest value, in the parameter's unit.
    pub fn bounds(&self, centre: f64, scales: &RecordingScales) -> [f64; 2] {
        let deviation = self.standard_deviation(scales);
        self.range.map(|deviations| match self.scale {
            PriorScale::Linear => centre + deviations * deviation,
            PriorScale::Logarithmic => centre * deviation.powf(deviations),
        })
    }

    /// Distance of `value` above `centre`, the value at which the effect has no influence, in standard deviations. On the
    /// logarithmic scale both are above zero.
    pub fn standardised(&self, value: f64, centre: f64, scales: &RecordingScales) -> f64 {
        let deviation = self.standard_deviation(scales);
        match self.scale {
            PriorScale::Linear => (value - centre) / deviation,
            PriorScale::Logarithmic => (value / centre).ln() / deviation.ln(),
        }
    }
}

/// Formats a value in SI units for display.
pub(super) fn for_people(value: f64, unit: &str) -> String {
    match unit {
        "m/s" => format!("{:.1} mm/s", 1e3 * value),
        "m2" => format!("{:.3} mm2", 1e6 * value),
        "-" => format!("{:.2} %", 1e2 * value),
        "Pa" => pressure_text(value),
        unit => format!("{value:.3} {unit}"),
    }
}
