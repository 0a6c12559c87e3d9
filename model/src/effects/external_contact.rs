//! A temporary external force.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::equations::smooth::window;
use crate::machine::{Machine, Mechanism};

/// A temporary external force.
///
/// It is a torque on the joint, because the point of contact on the link is unknown. Time comes with the inputs, so
/// the window belongs to one recording.
pub struct ExternalContact;

static CARD: Card = Card {
    name: text("external_contact"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text("A force from outside acts on the link in a part of the recording: ground, an obstacle, a person."),
    equation: text(
        "torque tau w(t), w = s(t - t0) s(t0 + d - t), s(x) = 1/(1 + exp(-2 x/e)), e = 30 ms; linear load: force F w(t)",
    ),
    source: text("practice"),
    shows: text(
        "Force error in one stretch of time and nowhere else, whatever the motion; not found again in another recording.",
    ),
    experiment: text("Repeat the manoeuvre in free air."),
    energy: text("Gives or takes tau w(t) times the joint's rate."),
};

const START: ParameterCard = ParameterCard {
    name: text("contact_start"),
    symbol: text("t0"),
    unit: text("s"),
    meaning: text("time after the first sample at which the contact begins, -1 where it is there from the beginning"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: -1.0,
    maximum: 1e5,
    typical: 1.0,
    start: Start::WorstStretchBegin,
    prior: None,
};

const DURATION: ParameterCard = ParameterCard {
    name: text("contact_duration"),
    symbol: text("d"),
    unit: text("s"),
    meaning: text("how long it lasts"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: 0.02,
    maximum: 1e5,
    typical: 1.0,
    start: Start::WorstStretchDuration,
    prior: None,
};

static LINK: &[ParameterCard] = &[
    START,
    DURATION,
    ParameterCard {
        name: text("contact_torque"),
        symbol: text("tau"),
        unit: text("N m"),
        meaning: text("torque on the joint, + = in the direction of growing angle"),
        kind: Kind::Linear,
        growth: Growth::TORQUE,
        minimum: -1e6,
        maximum: 1e6,
        typical: 300.0,
        start: Start::at(&[300.0]),
        prior: None,
    },
];

static LOAD: &[ParameterCard] = &[
    START,
    DURATION,
    ParameterCard {
        name: text("contact_force"),
        symbol: text("F"),
        unit: text("N"),
        meaning: text("force on the load, + = pushes the rod out"),
        kind: Kind::Linear,
        growth: Growth::FORCE,
        minimum: -1e6,
        maximum: 1e6,
        typical: 100.0,
        start: Start::at(&[50.0]),
        prior: None,
    },
];

impl Physics for ExternalContact {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, machine: &Machine, _site: Site) -> &[ParameterCard] {
        match machine.mechanism {
            Mechanism::LinearLoad => LOAD,
            _ => LINK,
        }
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        rows.torque[cylinder] += parameters[2] * window(now.time, parameters[0], parameters[1], now.time_scale);
    }
}
