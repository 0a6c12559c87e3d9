//! How far a model is from the measurement of one signal.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::validation::{self, ErrorSums, errors_of};

/// A simulated signal beside its measurement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct SignalComparison {
    /// Mean squared error over the variance of the measured signal (NMSE), both over all samples of the recordings.
    pub nmse: Option<f64>,
    /// Root mean squared error over all samples, in `unit`.
    pub rmse: Option<f64>,
    /// SI unit of the signal.
    #[serde(default)]
    pub unit: String,
    /// `100 (1 - sqrt(NMSE))`, %.
    pub fit: Option<f64>,
    /// Whether the signal counts in the mean NMSE. One that hardly changes, or that was derived from a noisy one, does not: sensor noise alone has an NMSE above 0.1 in it.
    #[serde(default = "counts")]
    pub in_mean: bool,
    /// Lag of the model behind the measurement at the frequency of the excitation, degrees; of several recordings the largest by size. `null` where no frequency stands out.
    pub phase_delay_deg: Option<f64>,
    /// Correlation of the error with its own past; of several recordings the one furthest beyond its bound. `null` where nothing can be said.
    pub autocorrelation: Option<Correlation>,
    /// Correlation of the error with the machine's input, as above.
    pub input_correlation: Option<Correlation>,
    /// How the squared error is shared between what the piston does; absent for several recordings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phases: Option<Vec<PhaseShare>>,
}

/// A correlation, at the lag where it is largest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Correlation {
    /// Correlation coefficient, -1 to 1.
    pub value: Option<f64>,
    /// By how much the error comes after what it is correlated with, s.
    pub lag_s: Option<f64>,
    /// Size that chance alone exceeds at any lag in one of a hundred recordings.
    pub bound: Option<f64>,
}

/// The part of a signal's squared error that falls into one phase of motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct PhaseShare {
    /// What the piston does: `moving`, `standing`, `at an end`.
    pub phase: String,
    /// Share of the time, 0 to 1.
    pub share_of_time: Option<f64>,
    /// Share of the squared error, 0 to 1.
    pub share_of_error: Option<f64>,
}

impl SignalComparison {
    /// Every signal by its contract name, over the comparisons of one model with several recordings.
    pub(super) fn all(comparisons: &[validation::Comparison]) -> BTreeMap<String, Self> {
        let each = errors_of(comparisons).into_iter();
        each.map(|(name, error)| (name.to_string(), Self::of(comparisons, name, error))).collect()
    }

    fn of(comparisons: &[validation::Comparison], name: &str, error: ErrorSums) -> Self {
        let all = || comparisons.iter().flat_map(|comparison| &comparison.signals);
        let own = || all().filter(|signal| signal.name == name);
        let delays = own().filter_map(|signal| signal.phase_delay_degrees);
        let phases = match comparisons {
            [_] => own().next().map(|signal| signal.phases.iter().map(PhaseShare::of).collect()),
            _ => None,
        };
        SignalComparison {
            nmse: finite(error.normalised()),
            rmse: finite(error.root_mean_square()),
            unit: own().next().map(|signal| signal.unit.to_string()).unwrap_or_default(),
            fit: finite(error.fit_percent()),
            in_mean: error.tells(),
            phase_delay_deg: delays.max_by(|a, b| a.abs().total_cmp(&b.abs())).and_then(finite),
            autocorrelation: Correlation::worst(own().filter_map(|signal| signal.autocorrelation)),
            input_correlation: Correlation::worst(own().filter_map(|signal| signal.input_correlation)),
            phases,
        }
    }
}

/// Older results have no such key: all of their signals counted.
fn counts() -> bool {
    true
}

impl Correlation {
    /// The one that is furthest beyond its bound.
    fn worst(found: impl Iterator<Item = validation::Correlation>) -> Option<Self> {
        let beyond = |one: &validation::Correlation| one.value.abs() / one.bound;
        let worst = found.max_by(|a, b| beyond(a).total_cmp(&beyond(b)))?;
        Some(Correlation { value: finite(worst.value), lag_s: finite(worst.lag), bound: finite(worst.bound) })
    }
}

impl PhaseShare {
    fn of(share: &validation::PhaseShare) -> Self {
        PhaseShare {
            phase: share.phase.to_string(),
            share_of_time: finite(share.of_time),
            share_of_error: finite(share.of_error),
        }
    }
}
