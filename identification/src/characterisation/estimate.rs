//! A value with its standard error.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An estimate with its standard error, both in the unit of the quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Estimate {
    /// Value.
    pub value: f64,
    /// Standard error.
    #[serde(rename = "std_error")]
    pub error: f64,
}

impl Estimate {
    /// Standard error over magnitude of the value; infinite for zero.
    pub fn relative_error(&self) -> f64 {
        if self.value == 0.0 { f64::INFINITY } else { (self.error / self.value).abs() }
    }

    /// The estimate in another unit, of which one has this many.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Estimate { value: factor * self.value, error: factor * self.error }
    }

    /// Mean of estimates, weighted by their errors. Its error is the larger of two: from their errors and from their scatter.
    /// Repeats that disagree therefore do not average to an unrealistic precision. `None` for an empty slice.
    pub fn mean(estimates: &[Estimate]) -> Option<Estimate> {
        let weights: Vec<f64> = estimates.iter().map(|one| one.error.powi(-2)).collect();
        let sum: f64 = weights.iter().sum();
        if !(sum.is_finite() && sum > 0.0) {
            return None;
        }
        let value = estimates.iter().zip(&weights).map(|(one, weight)| weight * one.value).sum::<f64>() / sum;
        let scatter: f64 = estimates.iter().zip(&weights).map(|(one, w)| w * (one.value - value).powi(2)).sum();
        let freedom = estimates.len().saturating_sub(1).max(1) as f64;
        Some(Estimate { value, error: (scatter / freedom).max(1.0).sqrt() / sum.sqrt() })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn scatter_beyond_the_errors_counts() {
        let agree = [1.0, 1.01].map(|value| Estimate { value, error: 0.1 });
        assert!((Estimate::mean(&agree).unwrap().error - 0.1 / 2.0_f64.sqrt()).abs() < 1e-12);
        let disagree = [0.0, 2.0].map(|value| Estimate { value, error: 0.1 });
        assert!((Estimate::mean(&disagree).unwrap().error - 1.0).abs() < 1e-9);
        assert_eq!(Estimate::mean(&[]), None);
    }
}
