//! Cavitation: oil boils instead of stretching.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Cavitation: oil boils instead of stretching.
pub struct Cavitation;

static CARD: Card = Card {
    name: text("cavitation"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Oil,
    family: Family::Base,
    summary: text("Pressure cannot fall below the vapour pressure: vapour makes up the missing flow."),
    equation: text("Q+ = km max(0, pv - p+), likewise on the rod side"),
    source: text("textbook (e.g. Merritt, Hydraulic Control Systems)"),
    shows: text("A chamber pressure that rests at its floor while the piston runs ahead of the oil."),
    experiment: text("Lower a load fast."),
    energy: text("Supplies the volume of the vapour at nearly no pressure."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("vapour_pressure"),
        symbol: text("pv"),
        unit: text("Pa"),
        meaning: text("gauge pressure at which the oil boils"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: -101325.0,
        maximum: 0.0,
        typical: -9e4,
        start: Start::at(&[-9e4]),
        prior: None,
    },
    ParameterCard {
        name: text("make_up_gain"),
        symbol: text("km"),
        unit: text("m3/(s Pa)"),
        meaning: text("make-up flow per pressure deficit"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-3,
        typical: 1e-7,
        start: Start::at(&[1e-7]),
        prior: None,
    },
];

impl Physics for Cavitation {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn confines(&self) -> bool {
        true
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        fill_below(parameters[0], parameters[1], site, now, rows);
    }
}

/// Half width of the rounding of the corner where make-up flow starts, Pa: far less than the noise of a pressure sensor. With a
/// sharp corner the flow into a small chamber switches between two time constants a factor of a million apart, and a simulation
/// would need steps of 10 ns there.
const ROUNDING: f64 = 100.0;

/// Flow into each chamber whose pressure is below `limit` (Pa): `gain` (m3/(s Pa)) times the pressure deficit.
pub(super) fn fill_below<T: Scalar>(limit: T, gain: T, site: Site, now: &Situation<T>, rows: &mut Rows<T>) {
    let Site::Cylinder(cylinder) = site else { return };
    let piston = &now.pistons[cylinder];
    rows.cap_flow[cylinder] += lack(limit - piston.cap_pressure) * gain;
    rows.rod_flow[cylinder] += lack(limit - piston.rod_pressure) * gain;
}

/// The positive part with its corner rounded by a parabola; exact beyond one `ROUNDING` on either side.
fn lack<T: Scalar>(pressure: T) -> T {
    let (early, late) = ((pressure + ROUNDING).positive_part(), (pressure - ROUNDING).positive_part());
    (early * early - late * late) / (4.0 * ROUNDING)
}

#[cfg(test)]
mod tests {
    use super::{ROUNDING, lack};

    #[test]
    fn the_corner_is_rounded_and_nothing_else() {
        assert_eq!(lack(-ROUNDING), 0.0);
        assert_eq!(lack(-1e6), 0.0);
        assert!((lack(0.0) - ROUNDING / 4.0).abs() < 1e-9);
        for pressure in [ROUNDING, 2e4, 1e6] {
            assert!((lack(pressure) / pressure - 1.0).abs() < 1e-9);
        }
    }
}
