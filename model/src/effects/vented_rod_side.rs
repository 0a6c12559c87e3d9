//! The rod side of a single-acting cylinder.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// A rod side without oil: open to the tank, or to the air.
pub struct VentedRodSide;

static CARD: Card = Card {
    name: text("vented_rod_side"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Valve,
    family: Family::Construction,
    summary: text("The rod side is open to the tank or the air: the load brings the piston back."),
    equation: text("Q- = k (pt - p-) besides the metered flow, whose gain on the rod side is then zero"),
    source: text("hydraulics practice (single-acting cylinders)"),
    shows: text("Rod side pressure is that of the tank, whatever happens."),
    experiment: text("None is needed: the data sheet says it."),
    energy: text("Throttles next to nothing."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("vent_gain"),
    symbol: text("k"),
    unit: text("m3/(s Pa)"),
    meaning: text("flow per pressure difference to the tank"),
    kind: Kind::Linear,
    growth: Growth::FLOW,
    minimum: 0.0,
    maximum: 1e-4,
    typical: 1e-9,
    start: Start::at(&[1e-9]),
    prior: None,
}];

impl Physics for VentedRodSide {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        rows.rod_flow[cylinder] += parameters[0] * (now.tank_pressure - now.pistons[cylinder].rod_pressure);
    }
}
