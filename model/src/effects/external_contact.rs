//! Something outside pushes for a while.

use super::{ActsOn, Card, Family, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start};
use crate::equations::Situation;
use crate::equations::smooth::window;
use crate::machine::{Machine, Mechanism};

/// Something outside pushes for a while.
///
/// A torque on the joint, because nobody knows where on the link it touches. Time comes with the inputs, so the window
/// belongs to one recording.
pub struct ExternalContact;

static CARD: Card = Card {
    name: "external_contact",
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: "A force from outside acts on the link in a part of the recording: ground, an obstacle, a person.",
    equation: "torque tau w(t), w = s(t - t0) s(t0 + d - t), s(x) = 1/(1 + exp(-2 x/e)), e = 30 ms; linear load: force F w(t)",
    source: "practice",
    shows: "Force error in one stretch of time and nowhere else, whatever the motion; not found again in another recording.",
    experiment: "Repeat the manoeuvre in free air.",
    energy: "Gives or takes tau w(t) times the joint's rate.",
};

const START: ParameterCard = ParameterCard {
    name: "contact_start",
    symbol: "t0",
    unit: "s",
    meaning: "time after the first sample at which the contact begins, -1 where it is there from the beginning",
    kind: Kind::Shape,
    minimum: -1.0,
    maximum: 1e5,
    typical: 1.0,
    start: Start::WorstStretchBegin,
    prior: None,
};

const DURATION: ParameterCard = ParameterCard {
    name: "contact_duration",
    symbol: "d",
    unit: "s",
    meaning: "how long it lasts",
    kind: Kind::Shape,
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
        name: "contact_torque",
        symbol: "tau",
        unit: "N m",
        meaning: "torque on the joint, + = in the direction of growing angle",
        kind: Kind::Linear,
        minimum: -1e6,
        maximum: 1e6,
        typical: 300.0,
        start: Start::At(&[300.0]),
        prior: None,
    },
];

static LOAD: &[ParameterCard] = &[
    START,
    DURATION,
    ParameterCard {
        name: "contact_force",
        symbol: "F",
        unit: "N",
        meaning: "force on the load, + = pushes the rod out",
        kind: Kind::Linear,
        minimum: -1e6,
        maximum: 1e6,
        typical: 100.0,
        start: Start::At(&[50.0]),
        prior: None,
    },
];

impl Physics for ExternalContact {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        match machine.mechanism {
            Mechanism::LinearLoad => LOAD,
            Mechanism::SingleLink { .. } | Mechanism::TwoLink | Mechanism::PlanarChain { .. } => LINK,
        }
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        rows.torque[cylinder] += parameters[2] * window(now.time, parameters[0], parameters[1]);
    }
}
