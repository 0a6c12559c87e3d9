//! A formula as a physical effect.

use super::program::{Moment, Program};
use super::row::Row;
use super::symbol::Symbol;
use super::text::FormulaText;
use super::variable::Variable;
use crate::effects::{Card, ParameterCard, Physics, Site, Start};
use crate::equations::{Channel, Instruments, Rows, Situation};
use crate::machine::Machine;
use crate::scalar::Scalar;

/// A law read from a text.
#[derive(Debug, Clone)]
pub struct Law {
    pub(super) card: Card,
    pub(super) row: Row,
    pub(super) parameters: Vec<ParameterCard>,
    pub(super) states: Vec<StateLaw>,
    pub(super) program: Program,
    pub(super) text: FormulaText,
    /// Other cylinders named in its formulas.
    pub(super) others: Vec<String>,
    pub(super) reads_metering_flows: bool,
    pub(super) reads_temperature: bool,
}

/// Rate of change of a state of a law.
#[derive(Debug, Clone)]
pub(super) struct StateLaw {
    pub start: Program,
    pub rate: Program,
    pub scale: f64,
}

impl Law {
    /// Its row in the equations.
    pub fn row(&self) -> Row {
        self.row
    }

    /// The variables of its formula, in the order of their first occurrence.
    pub(super) fn variables(&self) -> impl Iterator<Item = Variable> {
        self.program.inputs.iter().filter_map(|input| match input {
            Symbol::Variable(variable, None) => Some(*variable),
            _ => None,
        })
    }

    /// The value of its formula in a situation, in the unit of its row: for given parameters in the order of their cards, and
    /// states in theirs. A law of the opening reads the situation's opening.
    pub fn value<T: Scalar>(&self, site: Site, parameters: &[T], states: &[T], now: &Situation<'_, T>) -> T {
        self.program.evaluate(&Law::moment(site, parameters, states, now))
    }

    fn moment<'a, 'm, T>(
        site: Site,
        parameters: &'a [T],
        states: &'a [T],
        now: &'a Situation<'m, T>,
    ) -> Moment<'a, 'm, T> {
        let cylinder = match site {
            Site::Cylinder(cylinder) => Some(cylinder),
            Site::PumpLine | Site::Machine => None,
        };
        Moment { parameters, states, now, cylinder, opening: None }
    }

    fn add<T: Scalar>(&self, site: Site, value: T, rows: &mut Rows<T>) {
        if self.row == Row::PumpLeak {
            rows.pump_flow -= value;
        }
        let Site::Cylinder(cylinder) = site else { return };
        match self.row {
            Row::PistonForce => rows.piston_force[cylinder] += value,
            Row::JointTorque => rows.torque[cylinder] += value,
            Row::CapFlow => rows.cap_flow[cylinder] += value,
            Row::RodFlow => rows.rod_flow[cylinder] += value,
            Row::PistonLeak => {
                rows.cap_flow[cylinder] -= value;
                rows.rod_flow[cylinder] += value;
            }
            Row::PumpToCap => {
                rows.cap_flow[cylinder] += value;
                rows.pump_flow -= value;
            }
            Row::PumpToRod => {
                rows.rod_flow[cylinder] += value;
                rows.pump_flow -= value;
            }
            Row::CapToTank => rows.cap_flow[cylinder] -= value,
            Row::RodToTank => rows.rod_flow[cylinder] -= value,
            _ => {}
        }
    }
}

impl Physics for Law {
    fn card(&self) -> &Card {
        &self.card
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        &self.parameters
    }

    fn value_where_left_out(&self, parameter: &str) -> Option<f64> {
        let card = self.parameters.iter().find(|card| card.name == parameter)?;
        match card.start {
            Start::Known(value) => Some(value),
            _ => None,
        }
    }

    fn formula(&self) -> Option<&FormulaText> {
        Some(&self.text)
    }

    fn has_power(&self) -> bool {
        !self.row.is_an_opening() && !self.row.is_a_reading()
    }

    fn why_not(&self, machine: &Machine, _site: Site) -> Option<String> {
        let missing = self.others.iter().find(|name| machine.cylinder_index(name).is_none())?;
        Some(format!("its formula needs a cylinder named \"{missing}\""))
    }

    fn states(&self) -> usize {
        self.states.len()
    }

    fn has_memory(&self) -> bool {
        !self.states.is_empty()
    }

    fn state_scale(&self, state: usize) -> f64 {
        self.states.get(state).map_or(1.0, |state| state.scale)
    }

    fn reads_metering_flows(&self) -> bool {
        self.reads_metering_flows
    }

    fn reads_temperature(&self) -> bool {
        self.reads_temperature
    }

    fn adjusts_others(&self) -> bool {
        self.row.is_an_opening()
    }

    fn opening<T: Scalar>(&self, site: Site, parameters: &[T], opening: T, now: &Situation<T>) -> T {
        if self.row != Row::Opening {
            return opening;
        }
        self.program.evaluate(&Moment { opening: Some(opening), ..Law::moment(site, parameters, &[], now) })
    }

    fn adjust<T: Scalar>(&self, site: Site, parameters: &[T], now: &mut Situation<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let of_edge = |opening: T, now: &Situation<T>| {
            self.program.evaluate(&Moment { opening: Some(opening), ..Law::moment(site, parameters, &[], now) })
        };
        match self.row {
            Row::SupplyOpening => {
                now.pistons[cylinder].supply_opening = of_edge(now.pistons[cylinder].supply_opening, now);
            }
            Row::ReturnOpening => {
                now.pistons[cylinder].return_opening = of_edge(now.pistons[cylinder].return_opening, now);
            }
            _ => {}
        }
    }

    fn distort<T: Scalar>(&self, site: Site, parameters: &[T], instruments: &mut Instruments<T>) {
        let channel = match (self.row, site) {
            (Row::CapPressureReading, Site::Cylinder(cylinder)) => Channel::CapPressure(cylinder),
            (Row::RodPressureReading, Site::Cylinder(cylinder)) => Channel::RodPressure(cylinder),
            (Row::DisplacementReading, Site::Cylinder(cylinder)) => Channel::Displacement(cylinder),
            (Row::PumpPressureReading, _) => Channel::PumpPressure,
            _ => return,
        };
        instruments.of_mut(channel).offset += self.program.of_parameters(parameters);
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        self.contribute_remembering(site, parameters, &[], now, rows);
    }

    fn contribute_remembering<T: Scalar>(
        &self,
        site: Site,
        parameters: &[T],
        states: &[T],
        now: &Situation<T>,
        rows: &mut Rows<T>,
    ) {
        if self.has_power() {
            let value = self.program.evaluate(&Law::moment(site, parameters, states, now));
            self.add(site, value, rows);
        }
    }

    fn remember<T: Scalar>(&self, site: Site, parameters: &[T], states: &[T], now: &Situation<T>, rates: &mut [T]) {
        let moment = Law::moment(site, parameters, states, now);
        for (rate, state) in rates.iter_mut().zip(&self.states) {
            *rate = state.rate.evaluate(&moment);
        }
    }

    fn begin<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, states: &mut [T]) {
        for (slot, state) in states.iter_mut().zip(&self.states) {
            *slot = state.start.evaluate(&Law::moment(site, parameters, &[], now));
        }
    }
}

impl Variable {
    /// Whether the row is a metering flow.
    pub(super) fn is_a_metering_flow(self) -> bool {
        matches!(self, Variable::CapFlow | Variable::RodFlow)
    }
}
