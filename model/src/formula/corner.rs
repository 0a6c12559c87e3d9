//! Widths over which the corners of a formula are rounded.
//!
//! A law with a jump stalls a simulation: at zero speed friction would change its sign at every step. So a formula's `sign`,
//! `step` and `if` change over a width, like the corners of the equations.

use super::dimension::Dimension;
use crate::equations::{Rounding, Situation};
use crate::machine::{Cylinder, Size};
use crate::scalar::Scalar;

/// The kind of a corner's argument, which sets the width of its rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Corner {
    /// A speed, rounded like the friction of the piston.
    Speed,
    /// A pressure, rounded like the flow of the valve's edges.
    Pressure,
    /// An opening, over a ten-thousandth of the largest one.
    Area,
    /// A position, over a ten-thousandth of the stroke.
    Length,
    /// A time, over 10 ms: longer than a sample interval, so that a fit can locate it.
    Time,
    /// A pure number, over a thousandth.
    Pure,
    /// Any other kind: no natural scale, so the corner is sharp.
    Sharp,
}

/// Width of a corner in time, s.
const TIME_WIDTH: f64 = 0.01;

/// Width of a corner in a pure number.
const PURE_WIDTH: f64 = 1e-3;

/// Width of a corner in an opening or a position, as a share of the largest opening or the stroke.
const SHARE_WIDTH: f64 = 1e-4;

impl Corner {
    /// The corner of an argument with this dimension.
    pub fn of(dimension: Dimension) -> Corner {
        let is = |unit: &str| Dimension::read(unit).is_ok_and(|known| known == dimension);
        if dimension.is_pure() {
            Corner::Pure
        } else if is("m/s") {
            Corner::Speed
        } else if is("Pa") {
            Corner::Pressure
        } else if is("m2") {
            Corner::Area
        } else if is("m") {
            Corner::Length
        } else if is("s") {
            Corner::Time
        } else {
            Corner::Sharp
        }
    }

    /// Half of the width over which the argument changes its sign at this cylinder, in the argument's unit.
    pub fn width<T: Scalar>(self, now: &Situation<'_, T>, cylinder: Option<usize>) -> T {
        let own = cylinder.and_then(|cylinder| now.machine.cylinders.get(cylinder));
        let rounding = cylinder.and_then(|cylinder| now.pistons.get(cylinder)).map(|piston| piston.rounding);
        let rounding = rounding.unwrap_or_else(|| Rounding::of_the_equations(&Size::REFERENCE));
        match self {
            Corner::Speed => rounding.reversal_speed,
            Corner::Pressure => rounding.transition_pressure,
            Corner::Area => {
                let largest = own.and_then(|own| own.chambers.as_ref()).map_or(0.0, |oil| oil.full_command());
                T::from(SHARE_WIDTH * largest)
            }
            Corner::Length => T::from(SHARE_WIDTH * own.map_or(0.0, Cylinder::usual_travel)),
            Corner::Time => T::from(TIME_WIDTH * now.time_scale),
            Corner::Pure => T::from(PURE_WIDTH),
            Corner::Sharp => T::from(0.0),
        }
    }
}
