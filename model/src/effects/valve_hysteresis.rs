//! Play between spool and opening.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::machine::{Machine, Size, Supply};

/// Play between spool and opening.
///
/// The ideal play moves its output only while its input pushes: `dz = du` at an edge. This law needs the input's rate, which a
/// sampled input does not have. Here the edge moves the memory z like a lag of [`FOLLOW_TIME`], and the output is the memory
/// limited by the edges: at an edge it equals the ideal play, between the edges it is the memory. The lag remains visible only
/// after a reversal: the memory is behind the ideal play by the distance `T |du/dt|` of the last millisecond before it. That
/// matters where the spool reversed within a few milliseconds, and vanishes where it slowed down first. The right-hand side is
/// continuous (Lipschitz), so sensitivities need no jump condition, and a linearly implicit step handles an edge like any other
/// stiff lag.
///
/// The location of the play decides what it affects. Between the sensor and the spool, it affects all lands of the spool,
/// including the bypass. In the pilot stage of the metering edges, it does not affect the bypass, which follows the sensor. A
/// share parameter sets the fraction for the bypass, because the pump pressure shows both cases equally clearly.
pub struct ValveHysteresis;

static CARD: Card = Card {
    name: text("valve_hysteresis"),
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text(
        "The opening follows the measured spool only after some play has been taken up: backlash, or friction in a pilot stage.",
    ),
    equation: text(
        "T dz/dt = y - z, y = z where |u - z| < w/2, else the edge u - w/2 or u + w/2; opening from y, bypass from u + c (y - u); T = 1 ms",
    ),
    source: text("[B] IV-B; play operator (e.g. Visintin, Differential Models of Hysteresis) in a rate form"),
    shows: text(
        "Flow against opening runs on two lines, one for opening and one for closing; after a reversal nothing happens for the width of the play.",
    ),
    experiment: text("Slow triangles of the spool around several mean openings."),
    energy: text("Changes the supply through the valve; dissipates nothing itself."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("play_width"),
        symbol: text("w"),
        unit: text("m2"),
        meaning: text("spool travel lost at each reversal, as an orifice area"),
        kind: Kind::Shape,
        growth: Growth::OPENING,
        minimum: 0.0,
        maximum: 5e-5,
        typical: 1e-5,
        start: Start::at(&[4e-6, 5e-7]),
        prior: None,
    },
    ParameterCard {
        name: text("bypass_share"),
        symbol: text("c"),
        unit: text("-"),
        meaning: text(
            "how much of the play the bypass has: 1 where it is on the same spool, 0 where it follows the sensor",
        ),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 0.0,
        maximum: 1.0,
        typical: 1.0,
        start: Start::at(&[0.5]),
        prior: None,
    },
];

impl Physics for ValveHysteresis {
    fn card(&self) -> &Card {
        &CARD
    }

    fn has_natural_maximum(&self, parameter: &str) -> bool {
        parameter == "bypass_share"
    }

    fn parameters(&self, machine: &Machine, _site: Site) -> &[ParameterCard] {
        // Without a pump line there is no bypass.
        if matches!(machine.supply, Supply::PumpLine(_)) { PARAMETERS } else { &PARAMETERS[..1] }
    }

    fn value_where_left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "bypass_share").then_some(1.0)
    }

    fn has_power(&self) -> bool {
        false
    }

    fn states(&self) -> usize {
        1
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn spool<T: Scalar>(&self, size: &Size, parameters: &[T], states: &[T], rates: &mut [T], spool: T) -> [T; 2] {
        let ahead = spool - states[0];
        let half = parameters[0] * 0.5;
        let pulled = (ahead - half).positive_part() - (-ahead - half).positive_part();
        rates[0] = pulled / (FOLLOW_TIME * size.time());
        let opening = states[0] + pulled;
        let bypass = parameters.get(1).map_or(opening, |share| spool + *share * (opening - spool));
        [opening, bypass]
    }
}

/// Time T in which the memory reaches an edge that moves it, s: the sample interval of a fast recorder, below which no difference
/// from the ideal play is visible.
const FOLLOW_TIME: f64 = 1.0e-3;
