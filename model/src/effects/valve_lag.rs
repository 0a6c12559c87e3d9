//! Lag of the spool.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::machine::{Machine, Size};

/// Lag of the spool.
///
/// The parameters are the total delay and a share r that sets its shape: 0 is a first-order lag, 1/4 two equal lags in
/// series, 1/2 a pure delay as far as slow signals can show, and more an overshooting spool (damping ratio `1/(2 sqrt r)`). A
/// recording determines these two numbers independently; a first-order time constant and a delay in series would be
/// correlated. Both states are openings that settle at the input.
pub struct ValveLag;

static CARD: Card = Card {
    name: text("valve_lag"),
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text(
        "The opening follows the command (or the measured spool) with a lag of first or second order, or late.",
    ),
    equation: text(
        "tau dz/dt = y - z, (r tau + T) d(y - z)/dt = u - y, opening from z; z/u = 1/(1 + tau s + (r tau + T) tau s^2), T = 0.2 ms",
    ),
    source: text("[B], [A] Remark 1"),
    shows: text("Errors in proportion to how fast the opening changes; everything comes late by the same time."),
    experiment: text("Steps and fast sines."),
    energy: text("Changes the supply through the valve; dissipates nothing itself."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("lag_time"),
        symbol: text("tau"),
        unit: text("s"),
        meaning: text(
            "time by which the opening comes late: the time constant of first order, the sum of all lags and delays else",
        ),
        kind: Kind::Shape,
        growth: Growth::TIME,
        minimum: 1e-4,
        maximum: 2.0,
        typical: 0.02,
        start: Start::at(&[0.01]),
        prior: None,
    },
    ParameterCard {
        name: text("second_order_share"),
        symbol: text("r"),
        unit: text("-"),
        meaning: text("0 first order, 0.25 two equal lags, 0.5 like a pure delay, more overshoots"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 0.0,
        maximum: 2.0,
        typical: 0.3,
        start: Start::at(&[0.0]),
        prior: None,
    },
];

impl Physics for ValveLag {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn value_where_left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "second_order_share").then_some(0.0)
    }

    fn states(&self) -> usize {
        2
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn spool<T: Scalar>(&self, size: &Size, parameters: &[T], states: &[T], rates: &mut [T], spool: T) -> [T; 2] {
        let (lag, share) = (parameters[0], parameters[1]);
        let (before, opening) = (states[0], states[1]);
        rates[1] = (before - opening) / lag;
        rates[0] = rates[1] + (spool - before) / (share * lag + FASTEST * size.time());
        [opening, opening]
    }
}

/// Time T of the second lag for a first-order lag, s: shorter than any recording can resolve, and avoids a division by zero.
const FASTEST: f64 = 2e-4;
