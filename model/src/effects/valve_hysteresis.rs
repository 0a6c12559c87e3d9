//! Play between spool and opening.

use super::{ActsOn, Card, Family, Kind, ParameterCard, Physics, Scalar, Site, Start};
use crate::machine::Machine;

/// Play between spool and opening.
///
/// The ideal play moves its output only while its input pushes: `dz = du` at an edge, a law in the input's rate, which a
/// sampled input does not have. Here the edge pulls z along like a lag of [`FOLLOW_TIME`]: z stays behind the ideal play by
/// at most `T |du/dt|`, that is 1e-7 m² or 0.1 % of a usual full opening at a full stroke per second, and holds exactly
/// inside the play. The right-hand side is continuous (Lipschitz), so sensitivities need no jump condition, and a
/// linearly implicit step takes an edge like any other stiff lag.
pub struct ValveHysteresis;

static CARD: Card = Card {
    name: "valve_hysteresis",
    acts_on: ActsOn::Valve,
    family: Family::Candidate,
    summary: "The opening follows the measured spool only after some play has been taken up: backlash, or friction in a pilot stage.",
    equation: "T dz/dt = max(0, u - z - w/2) - max(0, z - u - w/2), opening from z; T = 1 ms",
    source: "[B] IV-B; play operator (e.g. Visintin, Differential Models of Hysteresis) in a rate form",
    shows: "Flow against opening runs on two lines, one for opening and one for closing; after a reversal nothing happens for the width of the play.",
    experiment: "Slow triangles of the spool around several mean openings.",
    energy: "Changes the supply through the valve; dissipates nothing itself.",
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: "play_width",
    symbol: "w",
    unit: "m2",
    meaning: "spool travel lost at each reversal, as an orifice area",
    kind: Kind::Shape,
    minimum: 0.0,
    maximum: 5e-5,
    typical: 1e-5,
    start: Start::At(&[4e-6, 5e-7]),
}];

impl Physics for ValveHysteresis {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn states(&self) -> usize {
        1
    }

    fn spool<T: Scalar>(&self, parameters: &[T], states: &[T], rates: &mut [T], spool: T) -> T {
        let ahead = spool - states[0];
        let half = parameters[0] * 0.5;
        rates[0] = ((ahead - half).positive_part() - (-ahead - half).positive_part()) / FOLLOW_TIME;
        states[0]
    }
}

/// Time T in which the output reaches an edge that pulls it, s: the sample interval of a fast recorder, under which no
/// difference to the ideal play can be seen.
const FOLLOW_TIME: f64 = 1.0e-3;
