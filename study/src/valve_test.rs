//! A static valve test from a table of the owner.

use std::path::{Path, PathBuf};

use excavator_bags::map::{Dimension, Unit};
use excavator_bags::table::{Column, Table, TableFormat, Values};
use excavator_identification::characterisation::{Estimate, FlowReading, StaticEdge, StaticValve, static_valve};
use excavator_model::Model;
use excavator_model::effects::Site;
use excavator_model::machine::Drive;
use serde::Serialize;

use crate::WorkError;
use crate::read_values::{LEAST_SHARE, is_clear, put};

/// Where a static valve test stands, and what is known of it.
#[derive(Debug, Clone, Default)]
pub struct ValveTestTable {
    /// The table.
    pub table: PathBuf,
    /// Heading of the input; without, the column that is not the flow.
    pub input: Option<String>,
    /// Heading of the flow; without, the column whose heading has a unit of flow or the word.
    pub flow: Option<String>,
    /// Unit of the input; without, that of its heading.
    pub input_unit: Option<Unit>,
    /// Unit of the flow; without, that of its heading.
    pub flow_unit: Option<Unit>,
    /// Pressure drop over the edge, Pa.
    pub pressure_drop: f64,
    /// Input at which the valve is closed, SI; without, it is read from the test.
    pub null: Option<f64>,
}

/// What a static valve test tells.
#[derive(Debug, Clone, Serialize)]
pub struct ValveTested {
    /// Number of readings.
    pub readings: usize,
    /// Pressure drop over the edge, Pa.
    pub pressure_drop: f64,
    /// Unit of the input in the table.
    pub input_unit: String,
    /// Unit of the flow in the table.
    pub flow_unit: String,
    /// Null, gains, dead zones and plays, in SI units.
    pub valve: StaticValve,
    /// The same numbers in the units of the table.
    pub in_table_units: StaticValve,
}

impl ValveTestTable {
    /// Reads the test. `wanted` is the dimension that the model's valve takes.
    ///
    /// # Errors
    /// [`WorkError::Recording`] if the table cannot be read, [`WorkError::ValveTest`] if a column or a unit is missing, or if the
    /// readings are no test.
    pub fn read(&self, wanted: Option<Dimension>) -> Result<ValveTested, WorkError> {
        let table = Table::read(&self.table, &TableFormat::default())?;
        let flow = match &self.flow {
            Some(heading) => self.column(&table, heading)?,
            None => self.only(&table, "flow", "--flow", &is_flow)?,
        };
        let input = match &self.input {
            Some(heading) => self.column(&table, heading)?,
            None => self.only(&table, "input", "--input", &|column| column.name != flow.name && is_input(column))?,
        };
        let flow_unit =
            unit_of(flow, self.flow_unit).filter(|unit| unit.dimension == Dimension::Flow).ok_or_else(|| {
                self.wrong(format!("the heading \"{}\" has no unit of a flow; say --flow-unit, as in l/min", flow.name))
            })?;
        let input_unit = match (unit_of(input, self.input_unit), wanted) {
            (Some(unit), Some(wanted)) if unit.dimension != wanted => {
                return Err(self.wrong(format!(
                    "\"{}\" is in {}, and the model's valve takes {}; say --input-unit if the heading is wrong",
                    input.name,
                    unit.name,
                    wanted.si_unit()
                )));
            }
            (Some(unit), _) => unit,
            (None, Some(wanted)) => Unit::si(wanted),
            (None, None) => {
                return Err(
                    self.wrong(format!("the heading \"{}\" has no unit; say --input-unit, as in mA", input.name))
                );
            }
        };
        let (Values::Numbers(inputs), Values::Numbers(flows)) = (&input.values, &flow.values) else {
            return Err(self.wrong(format!("\"{}\" or \"{}\" holds dates, not numbers", input.name, flow.name)));
        };
        let readings: Vec<FlowReading> = inputs
            .iter()
            .zip(flows)
            .map(|(&input, &flow)| FlowReading {
                input: input_unit.to_si(input),
                flow: flow_unit.to_si(flow),
                pressure_drop: self.pressure_drop,
            })
            .collect();
        let valve = static_valve(&readings, self.null).map_err(|error| self.wrong(error.to_string()))?;
        Ok(ValveTested::of(readings.len(), self.pressure_drop, [input_unit, flow_unit], valve))
    }

    fn column<'t>(&self, table: &'t Table, heading: &str) -> Result<&'t Column, WorkError> {
        table
            .named(heading)
            .ok_or_else(|| self.wrong(format!("there is no column \"{heading}\"; the columns are {}", headings(table))))
    }

    /// The only column that fits.
    fn only<'t>(
        &self,
        table: &'t Table,
        what: &str,
        option: &str,
        fits: &dyn Fn(&Column) -> bool,
    ) -> Result<&'t Column, WorkError> {
        let mut found = table.columns.iter().filter(|column| fits(column));
        match (found.next(), found.next()) {
            (Some(column), None) => Ok(column),
            _ => {
                Err(self
                    .wrong(format!("which column is the {what}? say {option}; the columns are {}", headings(table))))
            }
        }
    }

    fn wrong(&self, reason: String) -> WorkError {
        WorkError::ValveTest { path: self.table.clone(), reason }
    }
}

fn headings(table: &Table) -> String {
    table.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>().join(", ")
}

fn unit_of(column: &Column, given: Option<Unit>) -> Option<Unit> {
    given.or_else(|| column.unit.as_deref().and_then(Unit::named))
}

fn is_flow(column: &Column) -> bool {
    let by_unit = column.unit.as_deref().and_then(Unit::named).map(|unit| unit.dimension == Dimension::Flow);
    let name = column.name.to_lowercase();
    by_unit.unwrap_or_else(|| name.contains("flow") || name == "q")
}

fn is_input(column: &Column) -> bool {
    let unit = column.unit.as_deref().and_then(Unit::named);
    unit.is_none_or(|unit| !matches!(unit.dimension, Dimension::Time | Dimension::Pressure | Dimension::Flow))
}

impl ValveTested {
    fn of(readings: usize, pressure_drop: f64, units: [Unit; 2], valve: StaticValve) -> Self {
        let [input, flow] = units.map(|unit| unit.factor());
        let as_input = |one: Estimate| one.scaled(1.0 / input);
        let as_gain = |one: Estimate| one.scaled(pressure_drop.sqrt() * input / flow);
        let edge = |edge: StaticEdge| StaticEdge {
            gain: as_gain(edge.gain),
            dead_zone: as_input(edge.dead_zone),
            play: edge.play.map(as_input),
            readings: edge.readings,
        };
        let in_table_units = StaticValve { null: as_input(valve.null), sides: valve.sides.map(|side| side.map(edge)) };
        let [input_unit, flow_unit] = units.map(|unit| unit.name.to_string());
        ValveTested { readings, pressure_drop, input_unit, flow_unit, valve, in_table_units }
    }

    /// Puts gains, null, dead zones and play into a model; a null, a dead zone or a play only if it is clear of zero. A side without
    /// readings keeps its gain.
    ///
    /// # Errors
    /// [`WorkError::Model`] if the cylinder at `place` cannot have one of the effects.
    pub fn put_into(&self, model: &mut Model, place: usize, table: &Path) -> Result<(), WorkError> {
        let site = Site::Cylinder(place);
        let source = format!("static test {}", table.display());
        let full = match model.machine.cylinders[place].chambers.map(|chambers| chambers.drive) {
            Some(Drive::Valve { full_command, .. }) => full_command,
            _ => return Ok(()),
        };
        let is_clear = |one: Estimate| is_clear(one, LEAST_SHARE * full);
        let StaticValve { null, sides } = self.valve;
        let shift = if is_clear(null) { null.value } else { 0.0 };
        let gains = sides.map(|side| side.map(|edge| edge.gain.value));
        put(model, "orifice_flow", site, &gains, &source)?;
        if shift != 0.0 {
            put(model, "valve_null", site, &[Some(shift)], &source)?;
        }
        let zones = [1.0, -1.0].into_iter().zip(sides).map(|(way, side)| {
            // A null that is not clear stays with the dead zones.
            side.map(|edge| Estimate { value: edge.dead_zone.value + way * (null.value - shift), ..edge.dead_zone })
        });
        let zones: Vec<Option<Estimate>> = zones.collect();
        if zones.iter().flatten().any(|zone| zone.value > 0.0 && is_clear(*zone)) {
            // A side that was not tested is taken to be like the other.
            let tested = |index: usize| zones[index].or(zones[1 - index]).map(|zone| zone.value.max(0.0));
            let values = [tested(0), tested(1)];
            put(model, "valve_dead_zone", site, &values, &source)?;
        }
        let plays =
            sides.iter().flatten().filter_map(|edge| edge.play).filter(|play| play.value > 0.0 && is_clear(*play));
        let plays: Vec<Estimate> = plays.collect();
        if let Some(mean) = Estimate::mean(&plays) {
            put(model, "valve_hysteresis", site, &[Some(mean.value)], &source)?;
        }
        Ok(())
    }
}
