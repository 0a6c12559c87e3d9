//! A bypass that starts to close late.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// A bypass that starts to close late.
///
/// One overlap for all sections of the valve block: its spools are cut alike, and their contributions to the pressure of
/// one line cannot be separated anyway unless they move alone.
pub struct BypassOverlap;

static CARD: Card = Card {
    name: text("bypass_overlap"),
    acts_on: ActsOn::PumpLine,
    needs: Needs::Valve,
    family: Family::Candidate,
    summary: text("The open centre stays fully open until the spool has travelled some way."),
    equation: text("section of the bypass umax - max(0, |u| - o) in place of umax - |u|: travel past the edge counts"),
    source: text("hydraulics practice (overlap of the centre lands of open-centre spools)"),
    shows: text("Pump pressure stays low for small openings and then follows a parallel curve."),
    experiment: text("Slow sweep of the spool from closed, with the cylinder at rest."),
    energy: text("Changes what the bypass loses; dissipates nothing itself."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("bypass_overlap"),
    symbol: text("o"),
    unit: text("m2"),
    meaning: text("spool travel before the bypass starts to close, as an orifice area"),
    kind: Kind::Shape,
    growth: Growth::OPENING,
    minimum: 0.0,
    maximum: 1e-4,
    typical: 1e-5,
    start: Start::at(&[3e-6]),
    prior: None,
}];

impl Physics for BypassOverlap {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn adjust<T: Scalar>(&self, _site: Site, parameters: &[T], now: &mut Situation<T>) {
        for piston in &mut now.pistons {
            piston.bypass_closing = (piston.bypass_closing - parameters[0]).positive_part();
        }
    }
}
