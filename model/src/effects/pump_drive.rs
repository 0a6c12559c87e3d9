//! Flow of a pump that drives its cylinder in a closed circuit.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// A pump between both chambers of a cylinder or motor: it moves oil from one to the other.
pub struct PumpDrive;

static CARD: Card = Card {
    name: text("pump_drive"),
    acts_on: ActsOn::Valve,
    needs: Needs::Pump,
    family: Family::Base,
    summary: text("A pump of its own moves oil from one chamber to the other."),
    equation: text("Q+ = k u, Q- = -k u, u = speed times displacement of the pump; u is bent by what acts on openings"),
    source: text("textbook (e.g. Merritt; Rahmfeld and Ivantysynova for displacement control)"),
    shows: text("Speed in proportion to the flow of the pump, whatever the load."),
    experiment: text("Steps of the speed or the displacement of the pump, in both directions."),
    energy: text("Supplies b (exp(p/b) - 1) Q to each chamber, from the shaft of the pump."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("pump_flow_share"),
    symbol: text("k"),
    unit: text("-"),
    meaning: text("true flow of the pump over speed times displacement"),
    kind: Kind::Linear,
    growth: Growth::NONE,
    minimum: 0.0,
    maximum: 2.0,
    typical: 1.0,
    start: Start::at(&[0.97]),
    prior: None,
}];

impl Physics for PumpDrive {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn takes_power_from_a_shaft(&self) -> bool {
        true
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let flow = parameters[0] * now.pistons[cylinder].opening;
        rows.cap_flow[cylinder] += flow;
        rows.rod_flow[cylinder] -= flow;
    }
}
