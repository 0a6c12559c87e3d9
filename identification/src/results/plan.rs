//! What is to be driven.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::design;

/// A sequence of manoeuvres within the limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Plan {
    /// Length, s.
    pub duration: Option<f64>,
    /// The manoeuvres, in order.
    pub manoeuvres: Vec<Manoeuvre>,
    /// Number of manoeuvres in the library.
    pub library: usize,
    /// How many of them stay within the limits.
    pub within_limits: usize,
}

/// One manoeuvre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Manoeuvre {
    /// Name in the library.
    pub name: String,
    /// When it begins, s after the start of the profile.
    pub start: Option<f64>,
}

impl Plan {
    /// Of a plan; `manoeuvres` are those in the library, and how many of them stay within the limits.
    pub(super) fn of(plan: &design::Plan, manoeuvres: (usize, usize)) -> Self {
        let chosen = plan.chosen.iter();
        Plan {
            duration: finite(plan.duration),
            manoeuvres: chosen.map(|(name, start)| Manoeuvre { name: name.clone(), start: finite(*start) }).collect(),
            library: manoeuvres.0,
            within_limits: manoeuvres.1,
        }
    }
}
