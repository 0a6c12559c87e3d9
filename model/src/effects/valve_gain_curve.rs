//! A nonlinear area law.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// A nonlinear area law.
///
/// Two terms: a slot that widens (c1) and the corners of notches (c2). The flow gains of `orifice_flow` are then those of
/// a valve that is just beginning to open.
pub struct ValveGainCurve;

static CARD: Card = Card {
    name: text("valve_gain_curve"),
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text("The open area is not in proportion to spool travel: the gain depends on how far the valve is open."),
    equation: text("opening = u (1 + c1 x + c2 x^2), x = |u|/umax"),
    source: text("[B] IV-A (gain as a function of the opening)"),
    shows: text(
        "Speed over opening times root of the pressure drop changes with opening, the same way in both directions.",
    ),
    experiment: text("Trapezoids of many amplitudes up to the full opening."),
    energy: text("Changes the supply through the valve; dissipates nothing itself."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("gain_curve_first"),
        symbol: text("c1"),
        unit: text("-"),
        meaning: text("relative change of the gain at full opening, linear part"),
        kind: Kind::Linear,
        growth: Growth::NONE,
        minimum: -0.95,
        maximum: 5.0,
        typical: 0.3,
        start: Start::at(&[0.0]),
        prior: None,
    },
    ParameterCard {
        name: text("gain_curve_second"),
        symbol: text("c2"),
        unit: text("-"),
        meaning: text("relative change of the gain at full opening, quadratic part"),
        kind: Kind::Linear,
        growth: Growth::NONE,
        minimum: -0.95,
        maximum: 5.0,
        typical: 0.3,
        start: Start::at(&[0.0]),
        prior: None,
    },
];

impl Physics for ValveGainCurve {
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
        opening * (travel * (parameters[0] + parameters[1] * travel) + 1.0)
    }
}
