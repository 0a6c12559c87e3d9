//! A spring at the joint.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::{Machine, Mechanism};

/// A spring at the joint.
///
/// Whether a machine has a spring is visible. So it is not a candidate of a diagnosis: a weak spring looks like gravity at
/// another angle, which is an offset of the displacement sensor. But if it explains data better than a candidate, that candidate
/// is not named. Add it by hand, as `joint_spring@arm`, and compare.
pub struct JointSpring;

static CARD: Card = Card {
    name: text("joint_spring"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Construction,
    summary: text(
        "A balance spring, a gas strut, or stiff hoses and cables: a joint torque that falls linearly with the angle.",
    ),
    equation: text("torque tau0 - k (q - qm), qm the angle at mid-stroke; linear load: force F0 - k s"),
    source: text("textbook (spring); [A] Eq. 1 for where it acts"),
    shows: text("Static pressure difference that changes with position otherwise than gravity does."),
    experiment: text("Slow strokes from end to end, in both directions."),
    energy: text("Stores k (q - qm)^2 / 2 - tau0 (q - qm)."),
};

const fn stiffness(unit: &'static str, growth: Growth, typical: f64) -> ParameterCard {
    ParameterCard {
        name: text("spring_stiffness"),
        symbol: text("k"),
        unit: text(unit),
        meaning: text("stiffness of the spring; below zero where it pushes away from the middle"),
        kind: Kind::Linear,
        growth,
        minimum: -1e6,
        maximum: 1e6,
        typical,
        start: Start::at(&[0.0]),
        prior: None,
    }
}

const fn preload(
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    growth: Growth,
    meaning: &'static str,
) -> ParameterCard {
    ParameterCard {
        name: text(name),
        symbol: text(symbol),
        unit: text(unit),
        meaning: text(meaning),
        kind: Kind::Linear,
        growth,
        minimum: -1e6,
        maximum: 1e6,
        typical: 100.0,
        start: Start::at(&[0.0]),
        prior: None,
    }
}

static LINK: &[ParameterCard] = &[
    stiffness("N m/rad", Growth::TORQUE, 300.0),
    preload(
        "spring_torque",
        "tau0",
        "N m",
        Growth::TORQUE,
        "its torque at mid-stroke, + = in the direction of growing angle",
    ),
];

static LOAD: &[ParameterCard] = &[
    stiffness("N/m", Growth::STIFFNESS, 1000.0),
    preload("spring_force", "F0", "N", Growth::FORCE, "its force at mid-stroke, + = pushes the rod out"),
];

impl Physics for JointSpring {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, machine: &Machine, _site: Site) -> &[ParameterCard] {
        match machine.mechanism {
            Mechanism::LinearLoad => LOAD,
            _ => LINK,
        }
    }

    fn potential<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>) -> Option<T> {
        let Site::Cylinder(cylinder) = site else { return None };
        let away = from_middle(cylinder, now);
        Some(parameters[0] * away * away * 0.5 - parameters[1] * away)
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        rows.torque[cylinder] += parameters[1] - parameters[0] * from_middle(cylinder, now);
    }
}

/// Joint coordinate relative to its value at mid-stroke, rad or m.
fn from_middle<T: Scalar>(cylinder: usize, now: &Situation<T>) -> T {
    now.pistons[cylinder].joint - now.machine.cylinders[cylinder].linkage.joint(0.0)
}
