//! The number type that the physics is written for: plain `f64`, or a dual number that carries derivatives along.

use num_dual::{DualNum, DualSVec64};

/// A real number, possibly with derivatives. Effects are written once for every `Scalar`; simulation evaluates them
/// with `f64`, Jacobians, sensitivities and regressors with [`Dual`].
pub trait Scalar: DualNum<Primitive = f64> + Copy {
    /// The value without derivatives.
    fn value(&self) -> f64 {
        self.re()
    }

    /// `self` where positive, else zero.
    fn positive_part(self) -> Self {
        if self.value() > 0.0 { self } else { Self::from(0.0) }
    }
}

impl<T: DualNum<Primitive = f64> + Copy> Scalar for T {}

/// Number of derivative directions in one [`Dual`]. Eight, because the states of one cylinder with its joint, its
/// pump line and time (six) fit into one pass, and because eight doubles are a whole number of vector registers on
/// every processor; more directions take several passes.
pub const DIRECTIONS: usize = 8;

/// A number with its derivatives in [`DIRECTIONS`] directions.
pub type Dual = DualSVec64<DIRECTIONS>;

/// A constant as a [`Dual`].
pub fn constant(value: f64) -> Dual {
    Dual::from(value)
}

/// The variable of direction `direction` (below [`DIRECTIONS`]).
pub fn variable(value: f64, direction: usize) -> Dual {
    Dual::from(value).derivative(direction)
}

/// The derivative of `number` in `direction`.
pub fn derivative(number: &Dual, direction: usize) -> f64 {
    number.eps.0.as_ref().map_or(0.0, |eps| eps[direction])
}
