//! Plausibility checks: finds wrong units and typing errors in a model that parses.

mod oddity;
mod oscillation;
mod trial;

pub use oddity::{Oddity, oddities};
pub use oscillation::{Oscillation, oscillations};
pub use trial::{Trial, trial};
