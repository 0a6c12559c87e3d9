//! Result of `compare`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{SignalComparison, finite};
use crate::validation;

/// A model beside a recording, simulated with its input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Comparison {
    /// Mean over the signals (those with `in_mean`) of their mean squared error over their variance (NMSE): 0 is a perfect match, 1 is no better than a constant.
    pub mean_nmse: Option<f64>,
    /// Another model on the same recording; `null` where none was given.
    pub against: Option<OtherComparison>,
    /// Another run of the machine beside the recording; `null` where none was given.
    pub repeat: Option<OtherComparison>,
    /// The signals by contract name: `arm.displacement`.
    pub signals: BTreeMap<String, SignalComparison>,
    /// What noise, habit and a model without physics reach on the same signals.
    pub baseline_nmse: Baselines,
    /// Frequency of the excitation, Hz; `null` where none stands out.
    pub excitation_frequency_hz: Option<f64>,
}

/// What stands beside the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OtherComparison {
    /// Mean NMSE over the signals.
    pub mean_nmse: Option<f64>,
    /// The signals by contract name.
    pub signals: BTreeMap<String, SignalComparison>,
}

/// Errors to compare a model's with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Baselines {
    /// Time for which a value is held, s.
    pub held_s: Option<f64>,
    /// The signals by contract name.
    pub signals: BTreeMap<String, Baseline>,
}

/// Errors of what is not the model, for one signal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Baseline {
    /// NMSE of sensor noise alone; of a velocity that was not measured, of the noise of the displacement that it was derived from.
    pub noise: Option<f64>,
    /// NMSE of a linear ARX model without physics that was fitted to this recording.
    pub arx: Option<f64>,
    /// NMSE of the value so long before as `held_s` says.
    pub held: Option<f64>,
}

impl Comparison {
    /// Of a comparison with its baselines, and with what stands beside it.
    pub fn of(
        comparison: &validation::Comparison,
        baselines: &validation::Baselines,
        against: Option<&validation::Comparison>,
        repeat: Option<&validation::Repeat>,
    ) -> Self {
        let each = comparison.signals.iter().zip(&baselines.signals).map(|(signal, own)| {
            let baseline = Baseline { noise: finite(own.noise), arx: finite(own.arx), held: finite(own.held) };
            (signal.name.clone(), baseline)
        });
        Comparison {
            mean_nmse: finite(comparison.mean_error()),
            against: against.map(OtherComparison::of),
            repeat: repeat.map(|run| OtherComparison::of(&run.comparison)),
            signals: SignalComparison::all(std::slice::from_ref(comparison)),
            baseline_nmse: Baselines { held_s: finite(baselines.held), signals: each.collect() },
            excitation_frequency_hz: comparison.excitation_frequency.and_then(finite),
        }
    }
}

impl OtherComparison {
    fn of(comparison: &validation::Comparison) -> Self {
        OtherComparison {
            mean_nmse: finite(comparison.mean_error()),
            signals: SignalComparison::all(std::slice::from_ref(comparison)),
        }
    }
}
