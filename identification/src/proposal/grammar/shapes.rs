//! Shape parameters of factors, and their start values.

use super::factor::Shape;
use super::quantity::{Levels, Quantity};

pub(super) const FALL: Shape = Shape {
    name: "v0",
    unit: "m/s",
    quantity: Quantity::Speed,
    levels: Levels::OfSize(&[0.03, 0.1, 0.3]),
    is_signed: false,
    meaning: "speed over which it falls",
};

pub(super) const KNEE: Shape = Shape {
    name: "v0",
    unit: "m/s",
    quantity: Quantity::Speed,
    levels: Levels::OfSize(&[0.1, 0.3, 1.0]),
    is_signed: false,
    meaning: "speed at which it saturates",
};

pub(super) const PLACE: Shape = Shape {
    name: "s0",
    unit: "m",
    quantity: Quantity::Position,
    levels: Levels::Quantiles(&[0.1, 0.3, 0.5, 0.7, 0.9]),
    is_signed: true,
    meaning: "position where it begins",
};

pub(super) const CENTRE: Shape = Shape {
    name: "s0",
    unit: "m",
    quantity: Quantity::Position,
    levels: Levels::Quantiles(&[0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.97]),
    is_signed: true,
    meaning: "position of its middle",
};

pub(super) const WIDTH: Shape = Shape {
    name: "w",
    unit: "m",
    quantity: Quantity::Position,
    levels: Levels::OfRange(&[0.05, 0.1, 0.3, 0.6]),
    is_signed: false,
    meaning: "width",
};

pub(super) const WAVE_LENGTH: Shape = Shape {
    name: "l",
    unit: "m",
    quantity: Quantity::Position,
    // From half a wave to six waves along the travel.
    levels: Levels::OfRange(&[0.32, 0.16, 0.106, 0.08, 0.053, 0.04, 0.0265]),
    is_signed: false,
    meaning: "length of a wave over 2 pi",
};

pub(super) const PHASE: Shape = Shape {
    name: "f",
    unit: "-",
    quantity: Quantity::Position,
    // Together with the sign of the coefficient these are four phases.
    levels: Levels::Values(&[0.0, 1.57]),
    is_signed: true,
    meaning: "phase of the wave at mid-stroke",
};

/// A pressure above the tank pressure from which, or up to which, something opens. It is never below the tank pressure.
pub(super) const fn threshold(quantity: Quantity, levels: &'static [f64]) -> Shape {
    Shape {
        name: "p0",
        unit: "Pa",
        quantity,
        levels: Levels::Quantiles(levels),
        is_signed: false,
        meaning: "pressure where it begins",
    }
}

pub(super) const LOAD_THRESHOLD: Shape = Shape {
    name: "p0",
    unit: "Pa",
    quantity: Quantity::Load,
    levels: Levels::OfSize(&[0.2, 0.4, 0.6, 0.8]),
    is_signed: false,
    meaning: "pressure difference where it begins",
};

pub(super) const LAG: Shape = Shape {
    name: "tau",
    unit: "s",
    quantity: Quantity::Speed,
    levels: Levels::Times(&[0.02, 0.1, 0.5]),
    is_signed: false,
    meaning: "time in which it follows",
};

pub(super) const BRISTLE: Shape = Shape {
    name: "g",
    unit: "m",
    quantity: Quantity::Position,
    levels: Levels::OfRange(&[0.002, 0.01, 0.05]),
    is_signed: false,
    meaning: "way over which it bends",
};

pub(super) const HIGH: &[f64] = &[0.5, 0.7, 0.85, 0.95];
pub(super) const LOW: &[f64] = &[0.02, 0.05, 0.1, 0.2];

pub(super) const SMALL_OPENING: Shape = Shape {
    name: "w",
    unit: "m2",
    quantity: Quantity::Opening,
    levels: Levels::OfSize(&[0.05, 0.15, 0.3, 0.5]),
    is_signed: false,
    meaning: "opening within which it acts",
};

pub(super) const WAY: Shape = Shape {
    name: "l",
    unit: "m",
    quantity: Quantity::Position,
    levels: Levels::OfRange(&[0.15, 0.4, 1.2]),
    is_signed: false,
    meaning: "way along which it changes by a factor of e",
};

pub(super) const FADING: Shape = Shape {
    name: "tau",
    unit: "s",
    quantity: Quantity::Time,
    levels: Levels::OfRange(&[0.05, 0.15, 0.5]),
    is_signed: false,
    meaning: "time in which it fades",
};
