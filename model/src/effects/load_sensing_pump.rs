//! A pump that keeps its pressure a margin above the highest load.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// A variable pump with a load-sensing regulator. The `flow` of the supply is its largest flow.
pub struct LoadSensingPump;

static CARD: Card = Card {
    name: text("load_sensing_pump"),
    acts_on: ActsOn::PumpLine,
    needs: Needs::Oil,
    family: Family::Construction,
    summary: text(
        "The pump swivels so that its pressure is a margin above the highest load pressure, within its largest flow and pressure.",
    ),
    equation: text(
        "Qp = clamp(k (ps - pp), 0, Qmax), T dps/dt = min(pl + pm, pc) - ps, pl the highest pressure at a metering edge fed by the pump, tank pressure with all valves closed",
    ),
    source: text("hydraulics practice (load-sensing systems); textbook (e.g. Murrenhoff)"),
    shows: text("Pump pressure follows the load a margin above it, and rests at the margin while nothing moves."),
    experiment: text("Move one cylinder at a time against different loads, then two at once."),
    energy: text("The pump supplies e(pp) q; what it does not give costs nothing."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("load_sensing_margin"),
        symbol: text("pm"),
        unit: text("Pa"),
        meaning: text("pressure that the pump keeps above the highest load"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 1e5,
        maximum: 1e7,
        typical: 2e6,
        start: Start::at(&[2e6]),
        prior: None,
    },
    ParameterCard {
        name: text("cut_off_pressure"),
        symbol: text("pc"),
        unit: text("Pa"),
        meaning: text("highest pressure of the pump"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 1e6,
        maximum: 1e8,
        typical: 2e7,
        start: Start::at(&[2e7]),
        prior: None,
    },
    ParameterCard {
        name: text("regulator_gain"),
        symbol: text("k"),
        unit: text("m3/(s Pa)"),
        meaning: text("flow per pressure that the pump lacks"),
        kind: Kind::Shape,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-6,
        typical: 1e-9,
        start: Start::at(&[1e-9]),
        prior: None,
    },
    ParameterCard {
        name: text("regulator_lag"),
        symbol: text("T"),
        unit: text("s"),
        meaning: text("time constant with which the pump's pressure follows the load's"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 1e-3,
        maximum: 2.0,
        typical: 0.05,
        start: Start::at(&[0.05]),
        prior: None,
    },
];

impl Physics for LoadSensingPump {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn states(&self) -> usize {
        1
    }

    fn has_memory(&self) -> bool {
        true
    }

    fn state_scale(&self, _state: usize) -> f64 {
        1e6
    }

    fn begin<T: Scalar>(&self, _site: Site, parameters: &[T], now: &Situation<T>, states: &mut [T]) {
        states[0] = wanted_pressure(parameters, now);
    }

    fn remember<T: Scalar>(&self, _site: Site, parameters: &[T], states: &[T], now: &Situation<T>, rates: &mut [T]) {
        rates[0] = (wanted_pressure(parameters, now) - states[0]) / parameters[3];
    }

    fn contribute_remembering<T: Scalar>(
        &self,
        _site: Site,
        parameters: &[T],
        states: &[T],
        now: &Situation<T>,
        rows: &mut Rows<T>,
    ) {
        let wanted = ((states[0] - now.pump_pressure) * parameters[2]).positive_part();
        // The equations already add the full supply flow to the line.
        rows.pump_flow -= (-wanted + now.pump_flow).positive_part();
    }
}

/// Target pressure of the regulator, Pa.
fn wanted_pressure<T: Scalar>(parameters: &[T], now: &Situation<T>) -> T {
    let above_load = highest_load(now) + parameters[0];
    above_load - (above_load - parameters[1]).positive_part()
}

/// Highest pressure at a metering edge that the pump feeds, Pa; the tank pressure if no valve is open.
fn highest_load<T: Scalar>(now: &Situation<T>) -> T {
    let sections = now.pistons.iter().zip(&now.machine.cylinders).filter_map(|(piston, cylinder)| {
        let full = cylinder.chambers.as_ref()?.full_command();
        let loaded = if piston.opening.value() >= 0.0 { piston.cap_pressure } else { piston.rod_pressure };
        let open = (piston.opening.abs() / (CONNECTED * full)).tanh();
        Some((loaded - now.tank_pressure) * open)
    });
    let highest = sections.fold(T::from(0.0), |most, load| most + (load - most).positive_part());
    highest + now.tank_pressure
}

/// Fraction of the full opening at which a section reports its load to the pump.
const CONNECTED: f64 = 0.01;
