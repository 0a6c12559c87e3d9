//! Open-centre bypass from pump to tank.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::equations::smooth::orifice_root;
use crate::machine::Machine;

/// Open-centre bypass from pump to tank.
pub struct OpenCentreBypass;

static CARD: Card = Card {
    name: text("open_centre_bypass"),
    acts_on: ActsOn::PumpLine,
    needs: Needs::Oil,
    family: Family::Base,
    summary: text("Pump flow that returns to tank through the open centre, closing as spools move."),
    equation: text(
        "pump line loses Cft phi(pp - pt) usum, usum = (sum_i (umax_i - |u_i|)^-2)^-1/2: sections in \
        series",
    ),
    source: text(
        "[A] Eq. 3; printed with u_i, which would open the bypass beyond its maximum for u < 0: |u_i| is \
        used.",
    ),
    shows: text("Pump pressure against spool travel."),
    experiment: text("Slow sweep of the spool with the cylinder at rest."),
    energy: text("Throttled between pump and tank, outside the cylinders."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("bypass_flow_gain"),
    symbol: text("Cft"),
    unit: text("m/(s sqrt(Pa))"),
    meaning: text("flow gain of the bypass"),
    kind: Kind::Linear,
    growth: Growth::FLOW_GAIN,
    minimum: 0.0,
    maximum: 1.0,
    typical: 1e-2,
    start: Start::at(&[1e-2]),
    prior: None,
}];

impl Physics for OpenCentreBypass {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, _site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let section = bypass_section(now);
        rows.pump_flow -= parameters[0]
            * section
            * orifice_root(now.pump_pressure - now.tank_pressure, T::from(now.bypass_transition));
    }
}

/// Bypass area usum in m²: the areas of all valves in series.
pub(super) fn bypass_section<T: Scalar>(now: &Situation<T>) -> T {
    let mut inverse_squares = T::from(0.0);
    for (cylinder, piston) in now.pistons.iter().enumerate() {
        let Some(chambers) = now.chambers(cylinder) else { continue };
        let left = -piston.bypass_closing + chambers.full_command();
        // A spool at or beyond its end closes the whole bypass; the sum would be infinite.
        if left.value() <= CLOSED_SHARE * chambers.full_command() {
            return T::from(0.0);
        }
        inverse_squares += (left * left).recip();
    }
    inverse_squares.sqrt().recip()
}

/// Fraction of the largest opening below which a bypass section counts as closed: a thousandth of a per cent.
const CLOSED_SHARE: f64 = 1e-5;
