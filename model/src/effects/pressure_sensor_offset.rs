//! Pressure sensors that do not read zero at ambient pressure.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::{Channel, Instruments};
use crate::machine::Machine;

/// Pressure sensors that do not read zero at ambient pressure.
///
/// A shape, not a linear coefficient: equations that take the measured pressure as input have it under a root.
pub struct PressureSensorOffset;

static CARD: Card = Card {
    name: text("pressure_sensor_offset"),
    acts_on: ActsOn::CylinderOrPumpLine,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text(
        "A pressure sensor reads the same amount too much or too little at all times; the machine feels nothing of it.",
    ),
    equation: text("reported p = p + o, for cap side, rod side or pump"),
    source: text("practice (zero shift of strain gauge pressure sensors)"),
    shows: text(
        "Measured pressure off by a constant; flows through the valve look wrong most where the pressure drop is small.",
    ),
    experiment: text("Read all pressures with the pump off and the load on its stop."),
    energy: text("None: it acts on the instrument."),
};

/// Largest offset, Pa: 2.5 % of the range of a 400 bar transmitter. One that is further off is broken, and a model that asks for more
/// lacks something else.
const LARGEST: f64 = 1e6;

static CYLINDER: &[ParameterCard] = &[
    ParameterCard {
        name: text("pressure_offset_cap"),
        symbol: text("o+"),
        unit: text("Pa"),
        meaning: text("what the cap side sensor adds"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: -LARGEST,
        maximum: LARGEST,
        typical: 5e4,
        start: Start::at(&[0.0]),
        prior: None,
    },
    ParameterCard {
        name: text("pressure_offset_rod"),
        symbol: text("o-"),
        unit: text("Pa"),
        meaning: text("what the rod side sensor adds"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: -LARGEST,
        maximum: LARGEST,
        typical: 5e4,
        start: Start::at(&[0.0]),
        prior: None,
    },
];

static PUMP_LINE: &[ParameterCard] = &[ParameterCard {
    name: text("pressure_offset"),
    symbol: text("op"),
    unit: text("Pa"),
    meaning: text("what the pump pressure sensor adds"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: -LARGEST,
    maximum: LARGEST,
    typical: 5e4,
    start: Start::at(&[0.0]),
    prior: None,
}];

impl Physics for PressureSensorOffset {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, site: Site) -> &[ParameterCard] {
        match site {
            Site::Cylinder(_) => CYLINDER,
            Site::PumpLine => PUMP_LINE,
            Site::Machine => &[],
        }
    }

    fn has_power(&self) -> bool {
        false
    }

    fn distort<T: Scalar>(&self, site: Site, parameters: &[T], instruments: &mut Instruments<T>) {
        match site {
            Site::Cylinder(cylinder) => {
                instruments.of_mut(Channel::CapPressure(cylinder)).offset += parameters[0];
                instruments.of_mut(Channel::RodPressure(cylinder)).offset += parameters[1];
            }
            Site::PumpLine => instruments.of_mut(Channel::PumpPressure).offset += parameters[0],
            Site::Machine => {}
        }
    }
}
