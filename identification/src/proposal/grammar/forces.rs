//! Forces on the piston and torques on the joint.

use excavator_model::formula::Row;

use super::factor::{Factor, memory, plain, remembering, shaped};
use super::shapes::{BRISTLE, CENTRE, FADING, FALL, KNEE, LAG, LOAD_THRESHOLD, PHASE, PLACE, WAVE_LENGTH, WAY, WIDTH};
use super::term::{Sized, Term};
use super::unit::{
    AREA, FORCE, LENGTH, LENGTH_2, LENGTH_3, PRESSURE, PRESSURE_2, PURE, RATE, RATE_2, ROOT_OF_PRESSURE, ROOT_OF_SPEED,
    SPEED, SPEED_2, TIME,
};
use super::{one_shape_at_most, with_products};

/// How a resisting force depends on speed.
pub(in crate::proposal) static RESISTING: &[Factor] = &[
    plain("coulomb", "sign(v)", PURE),
    plain("viscous", "v", SPEED),
    plain("quadratic", "v*abs(v)", SPEED_2),
    plain("root", "sign(v)*sqrt(abs(v))", ROOT_OF_SPEED),
    shaped("falling", "sign(v)*exp(-abs(v)/{v0})", PURE, &[FALL]),
    shaped("stribeck", "sign(v)*exp(-(v/{v0})^2)", PURE, &[FALL]),
    shaped("saturating", "tanh(v/{v0})", PURE, &[KNEE]),
];

/// How a torque on the joint depends on the joint; the first three are against the motion.
pub(super) static TURNING: &[Factor] = &[
    plain("joint_coulomb", "sign(qd)", PURE),
    plain("joint_viscous", "qd", RATE),
    plain("joint_quadratic", "qd*abs(qd)", RATE_2),
    plain("joint_spring", "q", PURE),
    plain("sine_of_joint", "sin(q)", PURE),
    plain("cosine_of_joint", "cos(q)", PURE),
];

/// How a force depends on anything but speed.
static PUSHING: &[Factor] = &[
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

/// What else a force or a leak may grow with.
pub(in crate::proposal) static GROWING: &[Factor] = &[
    plain("position", "s", LENGTH),
    plain("abs_position", "abs(s)", LENGTH),
    plain("square_position", "s^2", LENGTH_2),
    shaped("beyond", "step(s - {s0})", PURE, &[PLACE]),
    shaped("below", "step({s0} - s)", PURE, &[PLACE]),
    shaped("ramp_beyond", "max(s - {s0}, 0)", LENGTH, &[PLACE]),
    shaped("ramp_below", "max({s0} - s, 0)", LENGTH, &[PLACE]),
    shaped("around", "exp(-((s - {s0})/{w})^2)", PURE, &[CENTRE, WIDTH]),
    shaped("rising", "exp(s/{l})", PURE, &[WAY]),
    shaped("falling", "exp(-s/{l})", PURE, &[WAY]),
    plain("load", "(p_cap - p_rod)", PRESSURE),
    plain("abs_load", "abs(p_cap - p_rod)", PRESSURE),
    plain("square_load", "(p_cap - p_rod)^2", PRESSURE_2),
    plain("root_of_load", "sqrt(abs(p_cap - p_rod))", ROOT_OF_PRESSURE),
    shaped("large_load", "max(abs(p_cap - p_rod) - {p0}, 0)", PRESSURE, &[LOAD_THRESHOLD]),
    plain("cap_pressure", "p_cap", PRESSURE),
    plain("square_cap_pressure", "p_cap^2", PRESSURE_2),
    plain("root_of_cap_pressure", "sqrt(abs(p_cap))", ROOT_OF_PRESSURE),
    plain("rod_pressure", "p_rod", PRESSURE),
    plain("square_rod_pressure", "p_rod^2", PRESSURE_2),
    plain("root_of_rod_pressure", "sqrt(abs(p_rod))", ROOT_OF_PRESSURE),
    plain("sum_of_pressures", "(p_cap + p_rod)", PRESSURE),
    plain("pump_pressure", "p_pump", PRESSURE),
    // Load on pins and guides.
    plain("abs_force", "abs(area_cap*p_cap - area_rod*p_rod)", FORCE),
    plain("abs_opening", "abs(u)", AREA),
    plain("extending", "step(v)", PURE),
    plain("retracting", "step(-v)", PURE),
    plain("time", "t", TIME),
    shaped("fading", "exp(-t/{tau})", PURE, &[FADING]),
];

/// A wave along the stroke.
pub(super) static WAVE: Factor = shaped("wave", "sin(s/{l} + {f})", PURE, &[WAVE_LENGTH, PHASE]);

/// Forces with a memory.
pub(in crate::proposal) static REMEMBERING: &[Factor] = &[
    remembering("bristle", "{z}", LENGTH, &[BRISTLE], &[memory("0", "v - abs(v)/{g}*{z}", "m")]),
    remembering("lag_of_speed", "(v - {z})", SPEED, &[LAG], &[memory("v", "(v - {z})/{tau}", "m/s")]),
    remembering(
        "lag_of_load",
        "(p_cap - p_rod - {z})",
        PRESSURE,
        &[LAG],
        &[memory("p_cap - p_rod", "(p_cap - p_rod - {z})/{tau}", "Pa")],
    ),
];

/// Terms of forces and torques.
pub(super) fn forces(terms: &mut Vec<Term>) {
    let row = Row::PistonForce;
    with_products(terms, row, RESISTING, GROWING);
    for push in PUSHING {
        terms.push(Term::of(row, push));
        let along =
            |word: &str| matches!(word, "beyond" | "below" | "around" | "rising" | "falling" | "time" | "fading");
        let along = GROWING.iter().filter(|other| along(other.word) && one_shape_at_most(push, other));
        terms.extend(along.map(|other| Term::product(row, push, other)));
        if push.text.starts_with("(p_") || push.text.starts_with("p_") {
            let position = GROWING.iter().filter(|other| other.word.ends_with("position"));
            terms.extend(position.map(|other| Term::product(row, push, other)));
        }
    }
    terms.push(Term::product(row, &RESISTING[0], &WAVE));
    terms.extend(REMEMBERING.iter().map(|one| Term::of(row, one)));
    terms.extend(TURNING.iter().map(|turning| Term::of(Row::JointTorque, turning)));
    let pressed = GROWING.iter().filter(|other| matches!(other.word, "abs_force" | "abs_load" | "position"));
    terms.extend(
        pressed.flat_map(|other| TURNING[..2].iter().map(|turning| Term::product(Row::JointTorque, turning, other))),
    );
}

impl Sized {
    /// Whether it is a force or a torque against the motion.
    pub fn resists(&self) -> bool {
        let word = self.term.factors[0].word;
        let of_motion = RESISTING.iter().chain(&TURNING[..3]).any(|factor| factor.word == word);
        matches!(self.term.row, Row::PistonForce | Row::JointTorque) && of_motion && self.coefficient < 0.0
    }
}
