//! Factors that terms are products of.

use super::quantity::{Levels, Quantity};
use super::unit::{PURE, Unit};

/// A factor of a term.
#[derive(Debug, PartialEq)]
pub(in crate::proposal) struct Factor {
    /// Word for it in a name; empty for the factor one.
    pub word: &'static str,
    /// Its formula, with shape parameters and states in braces; empty for the factor one.
    pub text: &'static str,
    /// Its unit.
    pub unit: Unit,
    /// Its shape parameters.
    pub shapes: &'static [Shape],
    /// Its states.
    pub memory: &'static [Memory],
    /// Whether its text is a whole law with the coefficient `{k}` inside, which is zero at a coefficient of zero. Such
    /// a law is not a product. Its contribution is linear in the coefficient only to first order.
    pub is_whole: bool,
}

/// A state of a factor.
#[derive(Debug, PartialEq)]
pub(in crate::proposal) struct Memory {
    /// Its name in the factor.
    pub name: &'static str,
    /// Initial value, as a formula.
    pub start: &'static str,
    /// Rate of change, as a formula.
    pub rate: &'static str,
    /// Its unit.
    pub unit: &'static str,
}

/// A parameter in which a factor is nonlinear.
#[derive(Debug, PartialEq)]
pub(in crate::proposal) struct Shape {
    /// Its name in the factor.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The quantity that scales it.
    pub quantity: Quantity,
    /// Start values of the search.
    pub levels: Levels,
    /// Whether it may be negative.
    pub is_signed: bool,
    /// What it is.
    pub meaning: &'static str,
}

/// The factor one.
pub(in crate::proposal) static ONE: Factor = plain("", "", PURE);

pub(super) const fn plain(word: &'static str, text: &'static str, unit: Unit) -> Factor {
    Factor { word, text, unit, shapes: &[], memory: &[], is_whole: false }
}

/// A law that is not a product. `unit` is the unit of its row divided by that of its coefficient.
pub(super) const fn whole(word: &'static str, text: &'static str, unit: Unit) -> Factor {
    Factor { is_whole: true, ..plain(word, text, unit) }
}

pub(super) const fn shaped(word: &'static str, text: &'static str, unit: Unit, shapes: &'static [Shape]) -> Factor {
    Factor { word, text, unit, shapes, memory: &[], is_whole: false }
}

pub(super) const fn remembering(
    word: &'static str,
    text: &'static str,
    unit: Unit,
    shapes: &'static [Shape],
    memory: &'static [Memory],
) -> Factor {
    Factor { word, text, unit, shapes, memory, is_whole: false }
}

/// The state `z` of a factor.
pub(super) const fn memory(start: &'static str, rate: &'static str, unit: &'static str) -> Memory {
    Memory { name: "z", start, rate, unit }
}
