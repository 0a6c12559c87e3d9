//! Widths over which the corners of the physics are rounded.

use super::smooth::{LAMINAR_PRESSURE, SLIP_SPEED, orifice_root, rounded_sign, sign_with_corner};
use crate::machine::Size;
use crate::scalar::Scalar;

/// A speed far below any that differs from rest, m/s: the sign of rest itself remains zero.
const NO_SPEED: f64 = 1e-30;

/// A pressure drop far below any reading, Pa: the root of zero remains zero.
pub(super) const NO_PRESSURE: f64 = 1e-9;

/// Widths and shapes of the corners at one cylinder. Effects of the rounding family override the equations' defaults.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounding<T> {
    /// Regularisation velocity of friction, m/s.
    pub reversal_speed: T,
    /// Sharpness of friction's sign function ([`sign_with_corner`]); `None` for the hyperbolic tangent.
    pub corner_sharpness: Option<T>,
    /// Pressure drop below which the flow of the valve's edges is laminar, Pa.
    pub transition_pressure: T,
    /// Deviations of the end stops from the model file; `None` for no deviations.
    pub end_stop: Option<EndStopCorrection<T>>,
}

/// Deviations of real end stops from those of a model file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndStopCorrection<T> {
    /// Factor on the stiffness.
    pub stiffness: T,
    /// Factor on the damping.
    pub damping: T,
    /// Damping that does not depend on the depth, N s/m.
    pub viscous_damping: T,
    /// Piston travel beyond half the stroke: out, in, m.
    pub shifts: [T; 2],
}

impl<T> EndStopCorrection<T> {
    /// Applies `of` to each number.
    pub fn each<U>(&self, of: impl Fn(&T) -> U) -> EndStopCorrection<U> {
        EndStopCorrection {
            stiffness: of(&self.stiffness),
            damping: of(&self.damping),
            viscous_damping: of(&self.viscous_damping),
            shifts: self.shifts.each_ref().map(of),
        }
    }
}

impl<T> Rounding<T> {
    /// Applies `of` to each number.
    pub fn each<U>(&self, of: impl Fn(&T) -> U) -> Rounding<U> {
        Rounding {
            reversal_speed: of(&self.reversal_speed),
            corner_sharpness: self.corner_sharpness.as_ref().map(&of),
            transition_pressure: of(&self.transition_pressure),
            end_stop: self.end_stop.as_ref().map(|stop| stop.each(&of)),
        }
    }
}

impl<T: Scalar> Rounding<T> {
    /// Default rounding of the equations for a piston of this size.
    pub fn of_the_equations(size: &Size) -> Self {
        Rounding {
            reversal_speed: T::from(SLIP_SPEED * size.sliding),
            corner_sharpness: None,
            transition_pressure: T::from(LAMINAR_PRESSURE),
            end_stop: None,
        }
    }

    /// No rounding: `sgn(v)` and `sgn(dp) sqrt|dp|` as \[A\] prints them.
    pub fn none() -> Self {
        Rounding {
            reversal_speed: T::from(NO_SPEED),
            corner_sharpness: None,
            transition_pressure: T::from(NO_PRESSURE),
            end_stop: None,
        }
    }

    /// `sgn(v)` of a velocity in m/s.
    pub fn sign(&self, velocity: T) -> T {
        let ratio = velocity / self.reversal_speed;
        self.corner_sharpness.map_or_else(|| rounded_sign(ratio), |sharpness| sign_with_corner(ratio, sharpness))
    }

    /// `phi` of a pressure drop in Pa.
    pub fn root(&self, pressure_drop: T) -> T {
        orifice_root(pressure_drop, self.transition_pressure)
    }
}
