//! The factors that terms are products of.

use super::quantity::{Levels, Quantity};
use super::unit::{
    AREA, AREA_2, AREA_3, LENGTH, LENGTH_2, LENGTH_3, PRESSURE, PRESSURE_2, PURE, RATE, RATE_2, ROOT_OF_PRESSURE,
    SPEED, SPEED_2, SPEED_TIMES_LENGTH, TIME, Unit,
};

/// A factor of a term.
#[derive(Debug, PartialEq)]
pub(super) struct Factor {
    /// What it is, as a part of a name; empty for the factor one.
    pub word: &'static str,
    /// As a formula writes it, its shape parameters in braces; empty for the factor one.
    pub text: &'static str,
    /// Its unit.
    pub unit: Unit,
    /// Its shape parameters.
    pub shapes: &'static [Shape],
    /// Its memory, `{z}` in the text.
    pub memory: Option<Memory>,
}

/// A state of a factor.
#[derive(Debug, PartialEq)]
pub(super) struct Memory {
    /// Where it begins, as a formula.
    pub start: &'static str,
    /// How fast it changes, as a formula.
    pub rate: &'static str,
    /// Its unit.
    pub unit: &'static str,
}

/// A parameter in which a factor is not linear.
#[derive(Debug, PartialEq)]
pub(super) struct Shape {
    /// Its name in the factor.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is measured by.
    pub quantity: Quantity,
    /// Where a search begins.
    pub levels: Levels,
    /// Whether it may be below zero.
    pub is_signed: bool,
    /// What it is.
    pub meaning: &'static str,
}

const fn plain(word: &'static str, text: &'static str, unit: Unit) -> Factor {
    Factor { word, text, unit, shapes: &[], memory: None }
}

const fn shaped(word: &'static str, text: &'static str, unit: Unit, shapes: &'static [Shape]) -> Factor {
    Factor { word, text, unit, shapes, memory: None }
}

const fn remembering(
    word: &'static str,
    text: &'static str,
    unit: Unit,
    shapes: &'static [Shape],
    memory: Memory,
) -> Factor {
    Factor { word, text, unit, shapes, memory: Some(memory) }
}

const FALL: Shape = Shape {
    name: "v0",
    unit: "m/s",
    quantity: Quantity::Speed,
    levels: Levels::OfSize(&[0.03, 0.1, 0.3]),
    is_signed: false,
    meaning: "speed over which it falls",
};

const KNEE: Shape = Shape {
    name: "v0",
    unit: "m/s",
    quantity: Quantity::Speed,
    levels: Levels::OfSize(&[0.1, 0.3, 1.0]),
    is_signed: false,
    meaning: "speed at which it saturates",
};

const PLACE: Shape = Shape {
    name: "s0",
    unit: "m",
    quantity: Quantity::Position,
    levels: Levels::Quantiles(&[0.1, 0.3, 0.5, 0.7, 0.9]),
    is_signed: true,
    meaning: "position where it begins",
};

const CENTRE: Shape = Shape {
    name: "s0",
    unit: "m",
    quantity: Quantity::Position,
    levels: Levels::Quantiles(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]),
    is_signed: true,
    meaning: "position of its middle",
};

const WIDTH: Shape = Shape {
    name: "w",
    unit: "m",
    quantity: Quantity::Position,
    levels: Levels::OfRange(&[0.1, 0.3, 0.6]),
    is_signed: false,
    meaning: "width",
};

const WAVE_LENGTH: Shape = Shape {
    name: "l",
    unit: "m",
    quantity: Quantity::Position,
    // From half a wave to six waves along the way.
    levels: Levels::OfRange(&[0.32, 0.16, 0.106, 0.08, 0.053, 0.04, 0.0265]),
    is_signed: false,
    meaning: "length of a wave over 2 pi",
};

const PHASE: Shape = Shape {
    name: "f",
    unit: "-",
    quantity: Quantity::Position,
    // Together with the sign of the coefficient these are four.
    levels: Levels::Values(&[0.0, 1.57]),
    is_signed: true,
    meaning: "phase of the wave at mid-stroke",
};

const fn threshold(quantity: Quantity, levels: &'static [f64]) -> Shape {
    Shape {
        name: "p0",
        unit: "Pa",
        quantity,
        levels: Levels::Quantiles(levels),
        is_signed: true,
        meaning: "pressure where it begins",
    }
}

const LOAD_THRESHOLD: Shape = Shape {
    name: "p0",
    unit: "Pa",
    quantity: Quantity::Load,
    levels: Levels::OfSize(&[0.2, 0.4, 0.6, 0.8]),
    is_signed: false,
    meaning: "pressure difference where it begins",
};

const LAG: Shape = Shape {
    name: "tau",
    unit: "s",
    quantity: Quantity::Speed,
    levels: Levels::Times(&[0.02, 0.1, 0.5]),
    is_signed: false,
    meaning: "time in which it follows",
};

const BRISTLE: Shape = Shape {
    name: "g",
    unit: "m",
    quantity: Quantity::Position,
    levels: Levels::OfRange(&[0.002, 0.01, 0.05]),
    is_signed: false,
    meaning: "way over which it bends",
};

/// What a quantity has that its course of some time ago has not: the lag of a first order behind it.
const fn behind(start: &'static str, rate: &'static str, unit: &'static str) -> Memory {
    Memory { start, rate, unit }
}

const HIGH: &[f64] = &[0.5, 0.7, 0.85, 0.95];
const LOW: &[f64] = &[0.02, 0.05, 0.1, 0.2];

const SMALL_OPENING: Shape = Shape {
    name: "w",
    unit: "m2",
    quantity: Quantity::Opening,
    levels: Levels::OfSize(&[0.05, 0.15, 0.3, 0.5]),
    is_signed: false,
    meaning: "opening within which it acts",
};

/// The factor one.
pub(super) static ONE: Factor = plain("", "", PURE);

/// How a resisting force depends on speed.
pub(super) static RESISTING: [Factor; 6] = [
    plain("coulomb", "sign(v)", PURE),
    plain("viscous", "v", SPEED),
    plain("quadratic", "v*abs(v)", SPEED_2),
    shaped("falling", "sign(v)*exp(-abs(v)/{v0})", PURE, &[FALL]),
    shaped("stribeck", "sign(v)*exp(-(v/{v0})^2)", PURE, &[FALL]),
    shaped("saturating", "tanh(v/{v0})", PURE, &[KNEE]),
];

/// How a torque on the joint depends on the joint.
pub(super) static TURNING: [Factor; 6] = [
    plain("joint_coulomb", "sign(qd)", PURE),
    plain("joint_viscous", "qd", RATE),
    plain("joint_quadratic", "qd*abs(qd)", RATE_2),
    plain("joint_spring", "q", PURE),
    plain("sine_of_joint", "sin(q)", PURE),
    plain("cosine_of_joint", "cos(q)", PURE),
];

/// How a force depends on anything but speed.
pub(super) static PUSHING: [Factor; 11] = [
    plain("constant", "", PURE),
    plain("spring", "s", LENGTH),
    plain("cubic_spring", "s^3", LENGTH_3),
    plain("square_spring", "s*abs(s)", LENGTH_2),
    shaped("stop_beyond", "max(s - {s0}, 0)", LENGTH, &[PLACE]),
    shaped("stop_below", "max({s0} - s, 0)", LENGTH, &[PLACE]),
    plain("load", "(p_cap - p_rod)", PRESSURE),
    plain("cap_pressure", "p_cap", PRESSURE),
    plain("rod_pressure", "p_rod", PRESSURE),
    plain("pump_pressure", "p_pump", PRESSURE),
    plain("opening", "u", AREA),
];

/// What a force or a leak may grow with besides.
pub(super) static GROWING: [Factor; 16] = [
    plain("position", "s", LENGTH),
    plain("abs_position", "abs(s)", LENGTH),
    plain("square_position", "s^2", LENGTH_2),
    shaped("beyond", "step(s - {s0})", PURE, &[PLACE]),
    shaped("below", "step({s0} - s)", PURE, &[PLACE]),
    shaped("around", "exp(-((s - {s0})/{w})^2)", PURE, &[CENTRE, WIDTH]),
    plain("load", "(p_cap - p_rod)", PRESSURE),
    plain("abs_load", "abs(p_cap - p_rod)", PRESSURE),
    plain("cap_pressure", "p_cap", PRESSURE),
    plain("rod_pressure", "p_rod", PRESSURE),
    plain("sum_of_pressures", "(p_cap + p_rod)", PRESSURE),
    plain("pump_pressure", "p_pump", PRESSURE),
    plain("abs_opening", "abs(u)", AREA),
    plain("extending", "step(v)", PURE),
    plain("retracting", "step(-v)", PURE),
    plain("time", "t", TIME),
];

/// A wave along the stroke.
pub(super) static WAVE: Factor = shaped("wave", "sin(s/{l} + {f})", PURE, &[WAVE_LENGTH, PHASE]);

/// Forces with a memory.
pub(super) static REMEMBERING: [Factor; 3] = [
    remembering("bristle", "{z}", LENGTH, &[BRISTLE], behind("0", "v - abs(v)/{g}*{z}", "m")),
    remembering("lag_of_speed", "(v - {z})", SPEED, &[LAG], behind("v", "(v - {z})/{tau}", "m/s")),
    remembering(
        "lag_of_load",
        "(p_cap - p_rod - {z})",
        PRESSURE,
        &[LAG],
        behind("p_cap - p_rod", "(p_cap - p_rod - {z})/{tau}", "Pa"),
    ),
];

/// Oil that walls take up when the pressure has risen for a while, and give back.
pub(super) static CAP_WALL: [Factor; 1] =
    [remembering("lag", "(p_cap - {z})", PRESSURE, &[LAG], behind("p_cap", "(p_cap - {z})/{tau}", "Pa"))];
pub(super) static ROD_WALL: [Factor; 1] =
    [remembering("lag", "(p_rod - {z})", PRESSURE, &[LAG], behind("p_rod", "(p_rod - {z})/{tau}", "Pa"))];
pub(super) static PUMP_WALL: [Factor; 3] = [
    remembering("lag", "(p_pump - {z})", PRESSURE, &[LAG], behind("p_pump", "(p_pump - {z})/{tau}", "Pa")),
    remembering("lag_of_speed", "({c}.v - {z})", SPEED, &[LAG], behind("{c}.v", "({c}.v - {z})/{tau}", "m/s")),
    remembering("lag_of_opening", "({c}.u - {z})", AREA, &[LAG], behind("{c}.u", "({c}.u - {z})/{tau}", "m2")),
];

/// What a flow out of the pump line may depend on at a cylinder.
pub(super) static AT_CYLINDER: [Factor; 4] = [
    plain("abs_speed", "abs({c}.v)", SPEED),
    plain("speed", "{c}.v", SPEED),
    plain("abs_opening", "abs({c}.u)", AREA),
    plain("load", "({c}.p_cap - {c}.p_rod)", PRESSURE),
];

/// Speed without its sign, which drags oil along.
pub(super) static ABS_SPEED: Factor = plain("abs_speed", "abs(v)", SPEED);

/// How a flow past the piston depends on the pressure difference.
pub(super) static PAST_THE_PISTON: [Factor; 5] = [
    plain("laminar", "(p_cap - p_rod)", PRESSURE),
    plain("turbulent", "root(p_cap - p_rod)", ROOT_OF_PRESSURE),
    plain("square", "(p_cap - p_rod)*abs(p_cap - p_rod)", PRESSURE_2),
    shaped("relief", "sign(p_cap - p_rod)*max(abs(p_cap - p_rod) - {p0}, 0)", PRESSURE, &[LOAD_THRESHOLD]),
    plain("dragged", "v", SPEED),
];

/// How a flow out of the cap side depends on its pressure.
pub(super) static FROM_CAP: [Factor; 7] = [
    plain("laminar", "(p_cap - p_tank)", PRESSURE),
    plain("turbulent", "root(p_cap - p_tank)", ROOT_OF_PRESSURE),
    plain("square", "(p_cap - p_tank)*abs(p_cap - p_tank)", PRESSURE_2),
    shaped("above", "max(p_cap - p_tank - {p0}, 0)", PRESSURE, &[threshold(Quantity::CapPressure, HIGH)]),
    shaped("under", "max({p0} - (p_cap - p_tank), 0)", PRESSURE, &[threshold(Quantity::CapPressure, LOW)]),
    plain("area", "v", SPEED),
    plain("area_along_stroke", "v*s", SPEED_TIMES_LENGTH),
];

/// The same for the rod side.
pub(super) static FROM_ROD: [Factor; 7] = [
    plain("laminar", "(p_rod - p_tank)", PRESSURE),
    plain("turbulent", "root(p_rod - p_tank)", ROOT_OF_PRESSURE),
    plain("square", "(p_rod - p_tank)*abs(p_rod - p_tank)", PRESSURE_2),
    shaped("above", "max(p_rod - p_tank - {p0}, 0)", PRESSURE, &[threshold(Quantity::RodPressure, HIGH)]),
    shaped("under", "max({p0} - (p_rod - p_tank), 0)", PRESSURE, &[threshold(Quantity::RodPressure, LOW)]),
    plain("area", "v", SPEED),
    plain("area_along_stroke", "v*s", SPEED_TIMES_LENGTH),
];

/// How a flow out of the pump line depends on its pressure.
pub(super) static FROM_PUMP: [Factor; 4] = [
    plain("laminar", "(p_pump - p_tank)", PRESSURE),
    plain("turbulent", "root(p_pump - p_tank)", ROOT_OF_PRESSURE),
    plain("square", "(p_pump - p_tank)*abs(p_pump - p_tank)", PRESSURE_2),
    shaped("above", "max(p_pump - p_tank - {p0}, 0)", PRESSURE, &[threshold(Quantity::PumpPressure, HIGH)]),
];

/// How a flow along one way of the valve depends on the pressure drop.
pub(super) static PUMP_TO_CAP: [Factor; 2] =
    [plain("laminar", "(p_pump - p_cap)", PRESSURE), plain("turbulent", "root(p_pump - p_cap)", ROOT_OF_PRESSURE)];
pub(super) static PUMP_TO_ROD: [Factor; 2] =
    [plain("laminar", "(p_pump - p_rod)", PRESSURE), plain("turbulent", "root(p_pump - p_rod)", ROOT_OF_PRESSURE)];
pub(super) static CAP_TO_TANK: [Factor; 2] =
    [plain("laminar", "(p_cap - p_tank)", PRESSURE), plain("turbulent", "root(p_cap - p_tank)", ROOT_OF_PRESSURE)];
pub(super) static ROD_TO_TANK: [Factor; 2] =
    [plain("laminar", "(p_rod - p_tank)", PRESSURE), plain("turbulent", "root(p_rod - p_tank)", ROOT_OF_PRESSURE)];

/// How an edge of the valve may depend on the opening.
pub(super) static EDGE: [Factor; 6] = [
    plain("towards_cap", "max(u, 0)", AREA),
    plain("towards_rod", "max(-u, 0)", AREA),
    plain("square_opening", "u^2", AREA_2),
    plain("abs_opening", "abs(u)", AREA),
    // What a resistance in series takes: the first power of a series in it.
    plain("cube_towards_cap", "max(u, 0)^3", AREA_3),
    plain("cube_towards_rod", "max(-u, 0)^3", AREA_3),
];

/// How a change of the opening depends on the opening.
pub(super) static OPENING: [Factor; 7] = [
    plain("gain", "u", AREA),
    plain("square_gain", "u*abs(u)", AREA_2),
    plain("cubic_gain", "u^3", AREA_3),
    plain("overlap", "sign(u)", PURE),
    shaped("small_openings", "clamp(u, -{w}, {w})", AREA, &[SMALL_OPENING]),
    shaped("fading_overlap", "sign(u)*exp(-abs(u)/{w})", PURE, &[SMALL_OPENING]),
    plain("abs_gain", "abs(u)", AREA),
];

/// What an opening may depend on besides.
pub(super) static SHIFTING: [Factor; 12] = [
    plain("pump_pressure", "p_pump", PRESSURE),
    plain("cap_pressure", "p_cap", PRESSURE),
    plain("rod_pressure", "p_rod", PRESSURE),
    plain("load", "(p_cap - p_rod)", PRESSURE),
    plain("abs_load", "abs(p_cap - p_rod)", PRESSURE),
    plain("pressure_drop", "if(u > 0, p_pump - p_cap, p_pump - p_rod)", PRESSURE),
    plain("root_of_drop", "if(u > 0, root(p_pump - p_cap), root(p_pump - p_rod))", ROOT_OF_PRESSURE),
    plain("position", "s", LENGTH),
    plain("abs_position", "abs(s)", LENGTH),
    plain("abs_speed", "abs(v)", SPEED),
    plain("speed", "v", SPEED),
    plain("time", "t", TIME),
];
