//! Transition from laminar to turbulent flow in an orifice.

use super::{
    ActsOn, Card, Corner, Family, Finding, Growth, Kind, Needs, ParameterCard, Physics, Prior, PriorScale, Scalar,
    Site, Spread, Start, text,
};
use crate::equations::Situation;
use crate::equations::smooth::LAMINAR_PRESSURE;
use crate::machine::Machine;

/// Transition from laminar to turbulent flow in the valve's orifices.
///
/// The root law has an infinite slope at zero; a real orifice does not. At a small pressure drop the flow is laminar and
/// proportional to the drop. The equations round the root over 2 kPa. If the transition takes tens of kilopascals, as with narrow
/// slots and cold oil (or in another simulator), a chamber near tank pressure or near pump pressure fills more slowly than the
/// root law predicts.
pub struct OrificeTransition;

static CARD: Card = Card {
    name: text("orifice_transition"),
    acts_on: ActsOn::Valve,
    needs: Needs::Valve,
    family: Family::Rounding,
    summary: text(
        "The flow of the valve's edges turns turbulent at another pressure drop than the 2 kPa of the equations.",
    ),
    equation: text("phi(dp) = dp / (dp^2 + pl^2)^(1/4) at the four edges"),
    source: text("convention ([A] prints the root); critical Reynolds number of an orifice, textbook (Merritt 1967)"),
    shows: text(
        "Flow over sqrt(dp) that falls where the pressure drop is small; a return chamber near tank pressure whose pressure is too low.",
    ),
    experiment: text("Slow strokes with small openings, the return line nearly without pressure."),
    energy: text("None of its own: it rounds the metering loss."),
};

/// The transition of metering slots is between 0.2 kPa and 300 kPa: a slot of 0.1 mm in cold oil reaches the upper end. With a
/// factor of 8 per standard deviation, that is one deviation below 2 kPa and two and a half above.
const PRIOR: Prior = Prior { spread: Spread::Fixed(8.0), scale: PriorScale::Logarithmic, range: [-1.1, 2.4] };

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("transition_pressure"),
    symbol: text("pl"),
    unit: text("Pa"),
    meaning: text("pressure drop below which the flow is laminar"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: 1e2,
    maximum: 4e5,
    typical: 2e4,
    start: Start::at(&[LAMINAR_PRESSURE]),
    prior: Some(PRIOR),
}];

impl Physics for OrificeTransition {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn finding(&self, parameters: &[(f64, &str)]) -> Option<Finding> {
        let (drop, _) = *parameters.first()?;
        let sentences = [
            "The valve's flow becomes turbulent at another pressure drop than the usual 2 kPa",
            "The valves' flows become turbulent at other pressure drops than the usual 2 kPa",
        ];
        Some(Finding { sentences, value: format!("at {:.1} kPa", 1e-3 * drop) })
    }

    fn has_power(&self) -> bool {
        false
    }

    fn rounds(&self) -> Option<Corner> {
        Some(Corner::OrificeFlow)
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn adjust<T: Scalar>(&self, site: Site, parameters: &[T], now: &mut Situation<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        now.pistons[cylinder].rounding.transition_pressure = parameters[0];
    }
}
