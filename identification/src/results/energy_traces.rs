//! Powers over time in the result of `energy`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{finite, thinned};
use crate::energy;

/// Largest number of samples of a trace, about.
const SAMPLES: usize = 500;

/// Energy and powers of one cylinder with its joint, or of all together, over the first minutes of the recording. Samples are thinned to
/// about 500, which keep the extremes of rate, supply and dissipation; every column has one value for each time. `null` where a
/// value is not known.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct EnergyTrace {
    /// Time since the first sample, s.
    pub time: Vec<Option<f64>>,
    /// Opening of the valve, m²; of all cylinders together, that of the first one.
    pub opening: Vec<Option<f64>>,
    /// Stored energy H of the measured state, J.
    pub hamiltonian: Vec<Option<f64>>,
    /// Experimental rate: slope of `hamiltonian`, W.
    pub experimental_rate: Vec<Option<f64>>,
    /// Standard error of `experimental_rate` from sensor noise, W.
    pub experimental_rate_error: Vec<Option<f64>>,
    /// Analytical rate: supply and dissipation at the measured state, W.
    pub analytical_rate: Vec<Option<f64>>,
    /// Numerical rate: supply and dissipation at the simulated state, W.
    pub numerical_rate: Vec<Option<f64>>,
    /// Supply at the measured state, W.
    pub supply: Vec<Option<f64>>,
    /// Supply at the simulated state, W.
    pub numerical_supply: Vec<Option<f64>>,
    /// Power that all effects but the valve add at the measured state, W; negative: lost.
    pub dissipation: Vec<Option<f64>>,
    /// The same at the simulated state, W.
    pub numerical_dissipation: Vec<Option<f64>>,
    /// The dissipation by effect.
    pub terms: BTreeMap<String, PowerTrace>,
}

/// Power of one effect over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct PowerTrace {
    /// At the measured state, W.
    pub analytical: Vec<Option<f64>>,
    /// At the simulated state, W.
    pub numerical: Vec<Option<f64>>,
}

impl EnergyTrace {
    pub(super) fn of(trace: &energy::CylinderTraces) -> Self {
        let guides: [&[f64]; 3] = [&trace.experimental.value, &trace.supply.value, &trace.dissipation.value];
        let kept = thinned(&guides, trace.time.len(), SAMPLES);
        let column = |values: &[f64]| kept.iter().map(|&index| values.get(index).copied().and_then(finite)).collect();
        let term = |term: &energy::TermTrace| {
            let powers = PowerTrace { analytical: column(&term.analytical), numerical: column(&term.numerical) };
            (term.effect.to_string(), powers)
        };
        EnergyTrace {
            time: column(&trace.time),
            opening: column(&trace.opening),
            hamiltonian: column(&trace.hamiltonian.value),
            experimental_rate: column(&trace.experimental.value),
            experimental_rate_error: column(&trace.experimental.error),
            analytical_rate: column(&trace.analytical.value),
            numerical_rate: column(&trace.numerical),
            supply: column(&trace.supply.value),
            numerical_supply: column(&trace.numerical_supply),
            dissipation: column(&trace.dissipation.value),
            numerical_dissipation: column(&trace.numerical_dissipation),
            terms: trace.terms.iter().map(term).collect(),
        }
    }
}
