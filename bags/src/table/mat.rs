//! Reads MATLAB files of versions 4, 6 and 7 as tables: every real numeric vector is a column.

use rosbag2::ReadLimits;

use super::fault::TableFault;
use super::mat_variables::{Content, Variable};
use super::{Column, Table, Values, heading, mat4, mat5};
use crate::map::Unit;

/// Maximum number of columns read from a matrix; more are of no use.
const COLUMN_LIMIT: usize = 256;
/// A matrix is that many times as wide as it is high if its rows are signals.
const WIDTH_OF_ROWS: usize = 4;
/// Fields that hold the numbers of a signal, and those beside them with its name and its unit.
const NUMBERS: [&str; 5] = [".Data", ".values", ".Values", ".data", ".Value"];
const NAMES: [&str; 6] = [".Name", ".label", ".Label", ".name", ".title", ".Title"];
const UNITS: [&str; 4] = [".Unit", ".unit", ".Units", ".units"];

/// Reads the table in a file. `Err` contains the fault in one line.
pub(super) fn parse(bytes: &[u8], limits: &ReadLimits) -> Result<Table, TableFault> {
    let mut table = Table::default();
    let content = if mat5::is_mat5(bytes) {
        mat5::parse(bytes, &mut table.notes, limits)?
    } else if bytes.get(512..).is_some_and(|rest| rest.starts_with(b"\x89HDF\r\n\x1a\n"))
        || bytes.starts_with(b"\x89HDF")
    {
        return Err("it is a MATLAB 7.3 file (HDF5); save it with `save -v7` to have it read here".into());
    } else {
        Content { variables: mat4::parse(bytes, &mut table.notes, limits)?, ..Content::default() }
    };
    let Content { mut variables, texts, objects } = content;
    let axes = axes(&variables);
    let mut places = Vec::new();
    // Beside the numbers of a signal, each struct of an array has its type, its size and the like.
    if variables.iter().any(|variable| variable.values.len() > 1) {
        variables.retain(|variable| variable.values.len() > 1 || !variable.name.contains(")."));
    }
    for Variable { name, rows, values } in variables {
        places.push((name.clone(), table.columns.len()));
        let (name, unit) = described(&name, &texts);
        let name = if name.is_empty() { format!("column_{}", table.columns.len() + 1) } else { name };
        let columns = values.len().checked_div(rows).unwrap_or(0);
        // A row vector is treated as a column.
        if rows == 1 || columns == 1 {
            table.columns.push(Column { name, unit, values: Values::Numbers(values), times: None });
            continue;
        }
        let (rows, values) =
            if are_rows(rows, columns, &values) { (columns, transposed(rows, &values)) } else { (rows, values) };
        for (index, column) in values.chunks_exact(rows.max(1)).take(COLUMN_LIMIT).enumerate() {
            let name = format!("{name}[{}]", index + 1);
            let unit = unit.clone();
            table.columns.push(Column { name, unit, values: Values::Numbers(column.to_vec()), times: None });
        }
    }
    let place_of = |path: &String| places.iter().find(|(known, _)| known == path).map(|(_, place)| *place);
    for (signal, times) in &axes {
        if let (Some(signal), Some(times)) = (place_of(signal), place_of(times)) {
            table.columns[signal].times = Some(times);
        }
    }
    if !objects.is_empty() {
        let (names, first) = (objects.join(", "), objects[0].clone());
        let reason = format!(
            "{names}: an object of MATLAB, such as a timeseries, cannot be read here; save its numbers, as in t = {first}.Time; x = \
             {first}.Data; save('-v7', 'FILE.mat', 't', 'x')"
        );
        if table.columns.is_empty() {
            return Err(reason.into());
        }
        table.notes.push(reason);
    }
    if table.columns.is_empty() {
        return Err("it has no real numeric variable".into());
    }
    Ok(table)
}

/// Paths of the signals of dSPACE that have their own times, each with that of the times. `rec.Y(3).XIndex` is the number of its times
/// among several `rec.X(2).Data`.
fn axes(variables: &[Variable]) -> Vec<(String, String)> {
    if !variables.iter().any(|variable| variable.name.ends_with(".X(2).Data")) {
        return Vec::new();
    }
    let of = |variable: &Variable| {
        let signal = variable.name.strip_suffix(".XIndex")?;
        let (recording, _) = signal.rsplit_once(".Y")?;
        let number = variable.values.first().filter(|number| number.fract() == 0.0)?;
        Some((format!("{signal}.Data"), format!("{recording}.X({number}).Data")))
    };
    variables.iter().filter_map(of).collect()
}

/// The name and the unit that the fields beside the numbers of a signal give it.
fn described(path: &str, texts: &[(String, String)]) -> (String, Option<String>) {
    let stem = NUMBERS.iter().find_map(|field| path.strip_suffix(field));
    let beside = |fields: &[&str]| -> Option<&str> {
        let stem = stem?;
        let of =
            |field: &&str| texts.iter().find(|(path, text)| path.strip_prefix(stem) == Some(field) && !text.is_empty());
        fields.iter().find_map(of).map(|(_, text)| text.as_str())
    };
    let (name, unit) = match beside(&NAMES) {
        Some(label) => heading::split(label),
        // The number of a struct in its array is no unit.
        None if path.contains(')') => (path.to_string(), heading::split(path.rsplit('.').next().unwrap_or(path)).1),
        None => heading::split(path),
    };
    let unit = beside(&UNITS).and_then(Unit::named).map(|unit| unit.name.to_string()).or(unit);
    (name, unit)
}

/// Whether the rows of a matrix are signals, as `To File` of Simulink writes them: few long rows, of which the first only grows.
fn are_rows(rows: usize, columns: usize, values: &[f64]) -> bool {
    let first = || values.iter().step_by(rows.max(1));
    columns >= WIDTH_OF_ROWS * rows && first().zip(first().skip(1)).all(|(one, next)| next > one)
}

/// A matrix in column-major order with its rows as columns.
fn transposed(rows: usize, values: &[f64]) -> Vec<f64> {
    (0..rows).flat_map(|row| values.iter().copied().skip(row).step_by(rows.max(1))).collect()
}
