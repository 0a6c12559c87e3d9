//! A displacement sensor whose zero is not at mid-stroke.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::{Channel, Instruments};
use crate::machine::Machine;

/// A displacement sensor whose zero is not at mid-stroke.
pub struct DisplacementSensorOffset;

static CARD: Card = Card {
    name: text("displacement_sensor_offset"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text(
        "The displacement sensor reads the same amount too much or too little at all times; the machine feels nothing of it.",
    ),
    equation: text("reported s = s + o; joint angle and velocity are other instruments' or do not change"),
    source: text("practice (mounting tolerance of string and magnetostrictive sensors)"),
    shows: text(
        "Gravity and lever of the model belong to another posture: force error that changes with position; ends of the stroke met early on one side and late on the other.",
    ),
    experiment: text("Drive gently into both ends: the mean of the two readings is the offset."),
    energy: text("None: it acts on the instrument."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("displacement_offset"),
    symbol: text("o"),
    unit: text("m"),
    meaning: text("what the displacement sensor adds"),
    kind: Kind::Shape,
    growth: Growth::LENGTH,
    minimum: -0.5,
    maximum: 0.5,
    typical: 5e-3,
    start: Start::at(&[0.0]),
    prior: None,
}];

impl Physics for DisplacementSensorOffset {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn distort<T: Scalar>(&self, site: Site, parameters: &[T], instruments: &mut Instruments<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        instruments.of_mut(Channel::Displacement(cylinder)).offset += parameters[0];
    }
}
