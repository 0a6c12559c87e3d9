//! A valve that meters differently in the two directions.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// A valve that meters differently in the two directions.
///
/// A change added to the gains of `orifice_flow`, not separate gains: the rows stay linear in it, and zero is the nominal
/// model, so a search can start there.
pub struct ValveDirectionalGain;

static CARD: Card = Card {
    name: text("valve_directional_gain"),
    acts_on: ActsOn::Valve,
    needs: Needs::Valve,
    family: Family::Candidate,
    summary: text("The flow gains for u < 0 differ from those for u > 0, on the cap side and on the rod side."),
    equation: text(
        "u < 0: Q+ += dCf+ u phi(p+ - pt), Q- += -dCf- u phi(pp - p-), the pump gives the second; nothing for u > 0: gains of orifice_flow hold there",
    ),
    source: text("[B] Eq. 7-8"),
    shows: text(
        "Speed over opening times root of the pressure drop has another slope for retraction than for extension.",
    ),
    experiment: text("Trapezoids of equal amplitude in both directions, steady for half a second."),
    energy: text("Supplies b (exp(p/b) - 1) times its flow to each chamber."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("negative_gain_change_cap"),
        symbol: text("dCf+"),
        unit: text("m/(s sqrt(Pa))"),
        meaning: text("how much more the cap side edges pass for u < 0 than for u > 0"),
        kind: Kind::Linear,
        growth: Growth::FLOW_GAIN,
        minimum: -0.02,
        maximum: 0.02,
        typical: 1e-3,
        start: Start::at(&[0.0]),
        prior: None,
    },
    ParameterCard {
        name: text("negative_gain_change_rod"),
        symbol: text("dCf-"),
        unit: text("m/(s sqrt(Pa))"),
        meaning: text("how much more the rod side edges pass for u < 0 than for u > 0"),
        kind: Kind::Linear,
        growth: Growth::FLOW_GAIN,
        minimum: -0.02,
        maximum: 0.02,
        typical: 1e-3,
        start: Start::at(&[0.0]),
        prior: None,
    },
];

impl Physics for ValveDirectionalGain {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        if piston.opening.value() >= 0.0 {
            return;
        }
        let [cap_opening, rod_opening] = piston.edges();
        let drawn = -parameters[1] * rod_opening * piston.drawn_root(now.pump_pressure - piston.rod_pressure);
        rows.cap_flow[cylinder] += parameters[0] * cap_opening * piston.root(piston.cap_pressure - now.tank_pressure);
        rows.rod_flow[cylinder] += drawn;
        rows.pump_flow -= drawn;
    }
}
