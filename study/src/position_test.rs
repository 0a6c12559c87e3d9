//! Reference and position of a drive under its own position controller, from tables.

use std::path::{Path, PathBuf};

use excavator_bags::map::{Dimension, TimedColumn, timed_columns};
use excavator_bags::table::{Table, TableFormat};
use excavator_identification::positioner::{PositionRecording, PositionerFit, fit_positioner};

use crate::WorkError;
use crate::numbers::number;

/// Which columns are reference and position.
#[derive(Debug, Clone, Default)]
pub struct PositionColumns {
    /// Heading of the reference; without, the only column named so.
    pub reference: Option<String>,
    /// Heading of the position; without, the only other length.
    pub position: Option<String>,
}

/// Words of a reference.
const REFERENCES: [&str; 7] = ["ref", "setpoint", "desired", "command", "target", "soll", "demand"];

impl PositionColumns {
    /// A model from reference to position of the tables `fitted`, and its errors on `judging`.
    ///
    /// # Errors
    /// [`WorkError::Recording`] if a table cannot be read, [`WorkError::PositionTest`] if a column is missing,
    /// [`WorkError::Positioner`] if there is no model.
    pub fn fit(&self, fitted: &[PathBuf], judging: &[PathBuf]) -> Result<PositionerFit, WorkError> {
        let read = |paths: &[PathBuf]| paths.iter().map(|path| self.read(path)).collect::<Result<Vec<_>, _>>();
        Ok(fit_positioner(&read(fitted)?, &read(judging)?)?)
    }

    fn read(&self, path: &Path) -> Result<PositionRecording, WorkError> {
        let columns = timed_columns(&Table::read(path, &TableFormat::default())?);
        let says_reference = |column: &&TimedColumn| {
            let name = column.name.to_lowercase();
            REFERENCES.iter().any(|word| name.contains(word))
        };
        let is_length = |column: &&TimedColumn| column.unit.is_none_or(|unit| unit.dimension == Dimension::Length);
        let reference = pick(path, &columns, "reference", self.reference.as_deref(), &|one| says_reference(&one))?;
        let position = pick(path, &columns, "position", self.position.as_deref(), &|one| {
            is_length(&one) && one.name != reference.name
        })?;
        let in_metres = |column: &TimedColumn| -> Result<Vec<f64>, WorkError> {
            let unit = column.unit.filter(|unit| unit.dimension == Dimension::Length).ok_or_else(|| {
                let reason = format!("the heading \"{}\" has no unit of a length, as in \"x [mm]\"", column.name);
                WorkError::PositionTest { path: path.to_path_buf(), reason }
            })?;
            Ok(column.values.iter().map(|&value| unit.to_si(value)).collect())
        };
        let (reference_m, position_m) = (in_metres(reference)?, in_metres(position)?);
        let is_whole = |index: &usize| reference_m[*index].is_finite() && position_m[*index].is_finite();
        let kept: Vec<usize> = (0..reference_m.len().min(position_m.len())).filter(is_whole).collect();
        let at = |values: &[f64]| kept.iter().map(|&index| values[index]).collect();
        Ok(PositionRecording {
            source: path.display().to_string(),
            time: at(&position.time),
            reference: at(&reference_m),
            position: at(&position_m),
        })
    }
}

/// The column with this heading, or the only one that fits.
fn pick<'c>(
    path: &Path,
    columns: &'c [TimedColumn],
    what: &str,
    heading: Option<&str>,
    fits: &dyn Fn(&TimedColumn) -> bool,
) -> Result<&'c TimedColumn, WorkError> {
    let mut found = columns.iter().filter(|column| match heading {
        Some(heading) => column.name.eq_ignore_ascii_case(heading),
        None => fits(column),
    });
    match (found.next(), found.next()) {
        (Some(column), None) => Ok(column),
        _ => {
            let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
            let reason = format!("which column is the {what}? say --{what}; the columns are {}", names.join(", "));
            Err(WorkError::PositionTest { path: path.to_path_buf(), reason })
        }
    }
}

/// The result in a few sentences.
pub fn position_lines(fit: &PositionerFit) -> Vec<String> {
    let margin =
        |value: f64, error: f64, factor: f64| format!("{} ± {}", number(factor * value), number(1.96 * factor * error));
    let mut lines = vec![
        format!(
            "The position follows its reference {} ms later, up to {} Hz (3 dB).",
            number(1e3 * fit.follows_after),
            number(fit.bandwidth)
        ),
        format!(
            "Gain of the loop: {} 1/s. Dead band of the error: {} mm. Lag of the valve: {} ms. Delay of the reference: {} ms.",
            margin(fit.gain.value, fit.gain.error, 1.0),
            margin(fit.dead_band.value, fit.dead_band.error, 1e3),
            margin(fit.lag.value, fit.lag.error, 1e3),
            margin(fit.delay.value, fit.delay.error, 1e3)
        ),
    ];
    let predicted = fit.errors.iter().zip(&fit.relative_errors);
    lines.extend(predicted.map(|(error, share)| {
        format!(
            "A recording that was not fitted is predicted within {} mm (root mean square), {} % of the reference's amplitude.",
            number(1e3 * error),
            number(100.0 * share)
        )
    }));
    lines
}
