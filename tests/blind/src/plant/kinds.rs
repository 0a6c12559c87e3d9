//! A kind of effect that can be hidden: what it sets, how far it may go, and what is then true of it.

use super::Effects;

/// Four numbers in 0 to 1 that give an effect its individual form; strength comes on top.
pub type Shape = [f64; 4];

/// A kind of effect.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// The benchmark's own name, most often that of the catalogue.
    pub name: &'static str,
    /// Name in the catalogue; of a foreign one the benchmark's.
    pub answer: &'static str,
    /// Largest plausible factor on the strength; 1 is a middling machine fault.
    pub limit: f64,
    /// Sets the effect's numbers.
    pub set: fn(&mut Effects, &Shape, f64),
    /// Parameters under the names that identification may report them by.
    pub truth: fn(&Effects) -> Vec<(&'static str, f64)>,
    /// Whether a single recording can show it at all; see `docs/blind-benchmark.md`.
    pub identifiable: bool,
}

/// +1 or -1 from a number in 0 to 1.
pub(super) fn sign(number: f64) -> f64 {
    if number < 0.5 { -1.0 } else { 1.0 }
}

/// `low` to `high` from a number in 0 to 1.
pub(super) fn between(number: f64, low: f64, high: f64) -> f64 {
    low + number * (high - low)
}

pub(super) const fn new(
    name: &'static str,
    limit: f64,
    set: fn(&mut Effects, &Shape, f64),
    truth: fn(&Effects) -> Vec<(&'static str, f64)>,
) -> Kind {
    Kind { name, answer: name, limit, set, truth, identifiable: true }
}
