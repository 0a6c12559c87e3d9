//! The null of the valve: the input at which it is closed.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::machine::Machine;

/// The null of the valve: the input at which it is closed.
///
/// An amplifier for 0 to 12 V closes its valve near 6 V, and a servo valve has a null bias of a few per cent of its rated current.
/// The null is not a candidate of a diagnosis, because it is read from a recording without a fit: the piston stands where the valve
/// is closed. With a dead zone the null is the middle of the dead zone, so both cannot be fitted together and the null is held.
pub struct ValveNull;

static CARD: Card = Card {
    name: text("valve_null"),
    acts_on: ActsOn::Valve,
    needs: Needs::Valve,
    family: Family::Construction,
    summary: text("The valve is closed at an input other than zero."),
    equation: text("u(t) = input(t) - u0"),
    source: text("ISO 10770-1 (null bias); hydraulics practice (amplifiers for 0 to 12 V)"),
    shows: text("The piston moves while the input is zero, and stands at another input."),
    experiment: text("Slow small steps of the input around the one at which the piston stands."),
    energy: text("None: it shifts the input."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("valve_null"),
    symbol: text("u0"),
    unit: text("m2"),
    meaning: text("input at which the valve is closed"),
    kind: Kind::Shape,
    growth: Growth::OPENING,
    minimum: -1e-4,
    maximum: 1e-4,
    typical: 1e-6,
    start: Start::at(&[0.0]),
    prior: None,
}];

impl Physics for ValveNull {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn reads_input_rate(&self) -> bool {
        true
    }

    fn read<T: Scalar>(&self, parameters: &[T], reading: T, _rates: [T; 2]) -> T {
        reading - parameters[0]
    }
}
