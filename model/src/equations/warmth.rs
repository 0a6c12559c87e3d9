//! What the temperature does to oil and seals.

use crate::scalar::Scalar;

/// Properties of oil, relative to those for which the coefficients of the model hold. `None` is a factor of one, which costs
/// nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oil<T> {
    /// Viscosity, a pure number.
    pub viscosity: Option<T>,
    /// Compressibility, a pure number.
    pub compressibility: Option<T>,
}

impl<T> Oil<T> {
    /// Oil as the coefficients of the model describe it.
    pub const USUAL: Self = Oil { viscosity: None, compressibility: None };

    /// Applies `of` to each number.
    pub fn each<U>(&self, of: impl Fn(&T) -> U) -> Oil<U> {
        Oil { viscosity: self.viscosity.as_ref().map(&of), compressibility: self.compressibility.as_ref().map(&of) }
    }
}

impl<T: Scalar> Oil<T> {
    /// A drag that is `coefficient` with usual oil: it grows with the viscosity.
    pub fn dragging(&self, coefficient: T) -> T {
        self.viscosity.map_or(coefficient, |viscosity| coefficient * viscosity)
    }

    /// A laminar leakage that is `coefficient` with usual oil: it falls with the viscosity.
    pub fn leaking(&self, coefficient: T) -> T {
        self.viscosity.map_or(coefficient, |viscosity| coefficient / viscosity)
    }

    /// A compliance that is `compliance` with usual oil.
    pub fn yielding(&self, compliance: T) -> T {
        self.compressibility.map_or(compliance, |factor| compliance * factor)
    }
}

/// Properties of the oil and of the seals of a cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Warmth<T> {
    /// The oil.
    pub oil: Oil<T>,
    /// Friction of the seals relative to that of the model's coefficients, a pure number.
    pub seal_friction: Option<T>,
}

impl<T> Warmth<T> {
    /// Oil and seals as the coefficients of the model describe them.
    pub const USUAL: Self = Warmth { oil: Oil::USUAL, seal_friction: None };

    /// Applies `of` to each number.
    pub fn each<U>(&self, of: impl Fn(&T) -> U) -> Warmth<U> {
        Warmth { oil: self.oil.each(&of), seal_friction: self.seal_friction.as_ref().map(&of) }
    }
}
