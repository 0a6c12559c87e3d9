//! The area law of a spool over round ports.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// The area law of a spool over round ports, `[B]` Eq. 9.
///
/// The printed law is singular at full travel. Here `SPAN` of the printed travel is the full opening of the machine, so the law is
/// finite everywhere. Both laws agree at full opening: the gains of `orifice_flow` keep their meaning.
pub struct ValveAreaLaw;

/// Printed travel at full opening. Without a limit, the area is infinite there; at 0.9, it is 1.7 times the square of the travel.
const SPAN: f64 = 0.9;

static CARD: Card = Card {
    name: text("valve_area_law"),
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Construction,
    summary: text("The open area grows with the square of spool travel, as over round ports."),
    equation: text("opening = u (1 - k + k x sqrt((1 - z^4)/(1 - (z x)^4))), x = |u|/umax, z = 0.9"),
    source: text("[B] Eq. 9. As printed, the area is infinite at full travel: z keeps it finite"),
    shows: text(
        "Speed over opening times root of the pressure drop grows with opening, the same way in both directions.",
    ),
    experiment: text("Trapezoids of many amplitudes up to the full opening."),
    energy: text("Changes the supply through the valve; dissipates nothing itself."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("area_law_share"),
    symbol: text("k"),
    unit: text("-"),
    meaning: text("share of the law in the area: 0 in proportion to travel, 1 as printed"),
    // The area is linear in the share as long as the opening keeps its sign, which a large share would turn.
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: 0.0,
    maximum: 1.0,
    typical: 0.5,
    start: Start::at(&[1.0, 0.4]),
    prior: None,
}];

impl Physics for ValveAreaLaw {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn opening<T: Scalar>(&self, site: Site, parameters: &[T], opening: T, now: &Situation<T>) -> T {
        let travel = opening.abs() / now.largest_opening(site);
        // A spool that is driven past its full opening stays below the singularity.
        let most = T::from(1.05);
        let travel = if travel.value() > most.value() { most } else { travel };
        let printed = travel * SPAN;
        let square = printed * printed;
        let widening = (T::from(1.0 - SPAN.powi(4)) / (-square * square + 1.0)).sqrt();
        opening * (parameters[0] * (travel * widening - 1.0) + 1.0)
    }
}
