//! A spool sensor that does not read zero where the valve closes.

use super::prior::for_people;
use super::{
    ActsOn, Card, Family, Finding, Growth, Kind, Needs, ParameterCard, Physics, Prior, PriorScale, Scalar, Site,
    Spread, Start, text,
};
use crate::machine::Machine;

/// A spool sensor that does not read zero where the valve closes, by a fraction of its noise or of its converter's step.
///
/// No reading shows it, but the pressures do. Where two nearly closed edges share a pump's flow, or a nearly open valve almost
/// closes the bypass, a thousandth of the opening changes the pressure by more than a sensor's noise, and looks like a dead
/// zone.
pub struct SpoolSensorOffset;

static CARD: Card = Card {
    name: text("spool_sensor_offset"),
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Recording,
    summary: text("The spool's sensor reads a little more or less than the opening, everywhere the same."),
    equation: text("u(t) = reading(t) - u0"),
    source: text("practice (zero of a position transducer)"),
    shows: text(
        "A closed valve that seems to pass oil to one side, and to need a little more opening on the other; a dead zone far below the sensor's noise.",
    ),
    experiment: text("Hold a load with the valve closed, then meter slowly to both sides."),
    energy: text("None: it acts on the instrument."),
};

/// An ordinary position transducer is accurate to 0.5 % of the largest opening, which is two standard deviations.
const PRIOR: Prior =
    Prior { spread: Spread::OfLargestOpening { part: 2.5e-3 }, scale: PriorScale::Linear, range: [-2.0, 2.0] };

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("spool_offset"),
    symbol: text("u0"),
    unit: text("m2"),
    meaning: text("what the sensor reads where the valve is closed"),
    kind: Kind::Shape,
    growth: Growth::OPENING,
    minimum: -1e-5,
    maximum: 1e-5,
    typical: 1e-7,
    start: Start::at(&[0.0]),
    prior: Some(PRIOR),
}];

impl Physics for SpoolSensorOffset {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn finding(&self, parameters: &[(f64, &str)]) -> Option<Finding> {
        let &[(offset, unit)] = parameters else { return None };
        let sentences = [
            "The spool sensor does not read zero where its valve is closed",
            "The spool sensors do not read zero where their valves are closed",
        ];
        Some(Finding { sentences, value: format!("reads {} there", for_people(offset, unit)) })
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
