//! The criterion of \[A\] on the phases of energy rates.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::analysis::PhaseDelays;

/// Lag from which a rate of the stored energy no longer agrees with another one, degrees: \[A\] Section 5.2. Below it, the product of
/// two sines is positive on average, which passivity needs.
const LIMIT_DEGREES: f64 = 90.0;

/// Verdict on the phases of the experimental, analytical and numerical rates of the stored energy: every lag must stay below 90
/// degrees (\[A\] Section 5.2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct PhaseCriterion {
    /// Lag that must not be reached, degrees.
    pub limit_degrees: f64,
    /// Largest lag by size between any two rates, degrees; `null` where none is measured.
    pub largest_degrees: Option<f64>,
    /// Whether every lag is below the limit; `null` where a lag is not measured and the others are below it.
    pub met: Option<bool>,
    /// All of it in one sentence.
    pub sentence: String,
}

impl PhaseCriterion {
    /// Of the lags of all cylinders. `None` if there are none, because no frequency stands out.
    pub(super) fn of<'a>(delays: impl Iterator<Item = &'a PhaseDelays>) -> Option<Self> {
        let delays: Vec<&PhaseDelays> = delays.collect();
        if delays.is_empty() {
            return None;
        }
        let largest = delays.iter().filter_map(|one| one.largest()).max_by(f64::total_cmp);
        let met = match largest {
            Some(largest) if largest >= LIMIT_DEGREES => Some(false),
            Some(_) if delays.iter().flat_map(|one| one.all()).all(|lag| lag.is_some()) => Some(true),
            _ => None,
        };
        let sentence = match (met, largest) {
            (Some(true), Some(largest)) => format!(
                "The experimental, analytical and numerical rates of the stored energy agree in phase: the largest lag is {largest:.1}°, below {LIMIT_DEGREES:.0}°."
            ),
            (Some(false), Some(largest)) => format!(
                "The rates of the stored energy do not agree in phase: the largest lag is {largest:.1}°, and the limit is {LIMIT_DEGREES:.0}°."
            ),
            _ => format!(
                "Whether the rates of the stored energy agree in phase within {LIMIT_DEGREES:.0}° is not known: one of them has no component at the frequency of the excitation."
            ),
        };
        Some(PhaseCriterion { limit_degrees: LIMIT_DEGREES, largest_degrees: largest, met, sentence })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn judged(lags: [Option<f64>; 3]) -> PhaseCriterion {
        let [analytical, numerical, numerical_behind_analytical] = lags;
        let delays = PhaseDelays { frequency: 0.5, analytical, numerical, numerical_behind_analytical };
        PhaseCriterion::of([delays].iter()).unwrap()
    }

    #[test]
    fn lags_below_a_right_angle_meet_it() {
        let met = judged([Some(57.6), Some(-33.5), Some(0.0)]);
        assert_eq!((met.met, met.largest_degrees), (Some(true), Some(57.6)));
        assert!(met.sentence.contains("57.6°"), "{}", met.sentence);
    }

    #[test]
    fn one_lag_or_lead_of_a_right_angle_does_not() {
        let lead = judged([Some(1.0), Some(-120.0), None]);
        assert_eq!((lead.met, lead.largest_degrees), (Some(false), Some(120.0)));
        assert_eq!(judged([Some(90.0), Some(0.0), Some(0.0)]).met, Some(false));
    }

    #[test]
    fn a_rate_without_a_phase_leaves_it_open() {
        let open = judged([Some(1.0), None, None]);
        assert_eq!((open.met, open.largest_degrees), (None, Some(1.0)));
        assert!(open.sentence.contains("not known"), "{}", open.sentence);
        assert_eq!(PhaseCriterion::of([].iter()), None);
    }
}
