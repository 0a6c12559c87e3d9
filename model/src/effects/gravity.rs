//! Weight of the links.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::equations::planar_chain::{absolute_angle, add_weight};
use crate::machine::Machine;
use crate::machine::Mechanism;

/// Weight of the links.
pub struct Gravity;

static CARD: Card = Card {
    name: text("gravity"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Base,
    summary: text("Weight of the link that the cylinder carries."),
    equation: text(
        "torque -W1 g sin q1 on the first joint, -W2 g sin(q1 + q2) on both; one link: -W2 g sin(q1const \
        + q2); link i of a chain: -Wi g sin(q1 + ... + qi) on joints 1 to i; linear load: -Fg; rotor: -Tg",
    ),
    source: text("[A] Eq. 1, 4; the unit of W is kg m (Table 1), not m/s2 as in the text."),
    shows: text("Static pressure difference that changes with posture."),
    experiment: text("Slow moves over the whole stroke with holds."),
    energy: text("Stores potential energy -W g cos(q)."),
};

static LINK: &[ParameterCard] = &[ParameterCard {
    name: text("gravity_moment"),
    symbol: text("W"),
    unit: text("kg m"),
    meaning: text("mass times distance of the centre of gravity"),
    kind: Kind::Linear,
    growth: Growth::MASS_MOMENT,
    minimum: -1e6,
    maximum: 1e6,
    typical: 200.0,
    start: Start::at(&[200.0]),
    prior: None,
}];

static LOAD: &[ParameterCard] = &[ParameterCard {
    name: text("weight"),
    symbol: text("Fg"),
    unit: text("N"),
    meaning: text("weight of the load along the cylinder"),
    kind: Kind::Linear,
    growth: Growth::FORCE,
    minimum: -1e6,
    maximum: 1e6,
    typical: 1000.0,
    start: Start::at(&[1000.0]),
    prior: None,
}];

static ROTOR: &[ParameterCard] = &[ParameterCard {
    name: text("load_torque"),
    symbol: text("Tg"),
    unit: text("N m"),
    meaning: text("torque of a hanging load on the joint: its weight times the radius of the drum"),
    kind: Kind::Linear,
    growth: Growth::TORQUE,
    minimum: -1e6,
    maximum: 1e6,
    typical: 1000.0,
    start: Start::at(&[1000.0]),
    prior: None,
}];

impl Physics for Gravity {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, machine: &Machine, site: Site) -> &[ParameterCard] {
        match (&machine.mechanism, site) {
            (Mechanism::LinearLoad, _) => LOAD,
            (Mechanism::Rotor, _) => ROTOR,
            _ => LINK,
        }
    }

    fn why_not(&self, machine: &Machine, site: Site) -> Option<String> {
        match site {
            Site::Cylinder(joint) if machine.mechanism.is_upright(joint) => {
                Some("this joint's axis stands upright".to_string())
            }
            _ => None,
        }
    }

    /// `-W g cos` of the link's absolute angle, zero at level (\[A\] Eq. 9); `Fg q` for a linear load, `Tg q` for a rotor.
    fn potential<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>) -> Option<T> {
        let Site::Cylinder(cylinder) = site else { return None };
        let joint = now.pistons[cylinder].joint;
        let angle = match (&now.machine.mechanism, cylinder) {
            (Mechanism::LinearLoad | Mechanism::Rotor, _) => return Some(parameters[0] * joint),
            (Mechanism::SingleLink { base_angle }, _) => joint + *base_angle,
            (Mechanism::TwoLink, 0) => joint,
            (Mechanism::TwoLink, _) => now.pistons[0].joint + joint,
            (mechanism, _) => absolute_angle(cylinder, mechanism.chain()?, now),
        };
        Some(-parameters[0] * now.machine.gravity * angle.cos())
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        match (&now.machine.mechanism, cylinder) {
            (Mechanism::SingleLink { base_angle }, _) => {
                rows.torque[0] -= parameters[0] * now.machine.gravity * (piston.joint + *base_angle).sin();
            }
            (Mechanism::TwoLink, 0) => rows.torque[0] -= parameters[0] * now.machine.gravity * piston.joint.sin(),
            (Mechanism::TwoLink, _) => {
                let absolute = now.pistons[0].joint + piston.joint;
                let moment = parameters[0] * now.machine.gravity * absolute.sin();
                rows.torque[0] -= moment;
                rows.torque[1] -= moment;
            }
            (Mechanism::LinearLoad | Mechanism::Rotor, _) => rows.torque[cylinder] -= parameters[0],
            (mechanism, _) => {
                if let Some(chain) = mechanism.chain() {
                    add_weight(cylinder, parameters[0], chain, now, rows);
                }
            }
        }
    }
}
