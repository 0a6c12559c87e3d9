//! Lag of the spool.

use super::{ActsOn, Card, Family, Kind, ParameterCard, Physics, Scalar, Site, Start};
use crate::machine::Machine;

/// Lag of the spool.
pub struct ValveLag;

static CARD: Card = Card {
    name: "valve_lag",
    acts_on: ActsOn::Valve,
    family: Family::Candidate,
    summary: "The opening follows the command (or the measured spool) with a lag of first order.",
    equation: "tau d(spool)/dt = u - spool",
    source: "[B], [A] Remark 1",
    shows: "Errors in proportion to how fast the opening changes; everything comes late by the same time.",
    experiment: "Steps and fast sines.",
    energy: "Changes the supply through the valve; dissipates nothing itself.",
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: "lag_time",
    symbol: "tau",
    unit: "s",
    meaning: "time constant",
    kind: Kind::Shape,
    minimum: 1e-4,
    maximum: 2.0,
    typical: 0.02,
    start: Start::At(&[0.01]),
}];

impl Physics for ValveLag {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        PARAMETERS
    }

    fn states(&self) -> usize {
        1
    }

    fn spool<T: Scalar>(&self, parameters: &[T], states: &[T], rates: &mut [T], spool: T) -> T {
        rates[0] = (spool - states[0]) / parameters[0];
        states[0]
    }
}
