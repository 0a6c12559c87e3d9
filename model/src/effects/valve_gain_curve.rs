//! An area law that bends.

use super::{ActsOn, Card, Family, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start};
use crate::machine::Machine;

/// An area law that bends.
///
/// Two terms: a slot that widens (c1) and the corners of notches (c2). The flow gains of `orifice_flow` are then those of
/// a valve that has just opened.
pub struct ValveGainCurve;

static CARD: Card = Card {
    name: "valve_gain_curve",
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: "The open area is not in proportion to spool travel: the gain depends on how far the valve is open.",
    equation: "opening = u (1 + c1 x + c2 x^2), x = |u|/umax",
    source: "[B] IV-A (gain as a function of the opening)",
    shows: "Speed over opening times root of the pressure drop changes with opening, the same way in both directions.",
    experiment: "Trapezoids of many amplitudes up to the full opening.",
    energy: "Changes the supply through the valve; dissipates nothing itself.",
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: "gain_curve_first",
        symbol: "c1",
        unit: "-",
        meaning: "relative change of the gain at full opening, linear part",
        kind: Kind::Linear,
        minimum: -0.95,
        maximum: 5.0,
        typical: 0.3,
        start: Start::At(&[0.0]),
        prior: None,
    },
    ParameterCard {
        name: "gain_curve_second",
        symbol: "c2",
        unit: "-",
        meaning: "relative change of the gain at full opening, quadratic part",
        kind: Kind::Linear,
        minimum: -0.95,
        maximum: 5.0,
        typical: 0.3,
        start: Start::At(&[0.0]),
        prior: None,
    },
];

impl Physics for ValveGainCurve {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn opening<T: Scalar>(&self, parameters: &[T], opening: T, maximum: f64) -> T {
        let travel = opening.abs() / maximum;
        opening * (travel * (parameters[0] + parameters[1] * travel) + 1.0)
    }
}
