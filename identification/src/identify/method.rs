//! Methods of identification.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How parameters are identified.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The one of weak form, output error and simulation error that predicts the end of the recordings best from the rest.
    Best,
    /// Weak form of the equations with instruments from the simulated model: not biased by sensor noise.
    WeakForm,
    /// Ordinary least squares on smoothed differences, the recipe of Arai et al. 2021; biased by noise.
    LeastSquares,
    /// Weak form, then simulated outputs fitted to the measured ones: over short segments with free initial states, and with the
    /// errors of instruments as further unknowns.
    OutputError,
    /// Weak form, then outputs fitted that are simulated from measured states over longer stretches: what a comparison judges. A model
    /// that lacks physics gets the parameters that make up for it best.
    SimulationError,
}

impl fmt::Display for Method {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Method::Best => "the method that predicts best",
            Method::WeakForm => "weak form with instruments",
            Method::LeastSquares => "least squares",
            Method::OutputError => "output error",
            Method::SimulationError => "simulation error",
        })
    }
}
