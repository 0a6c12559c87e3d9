//! The contents of a table, before a map assigns its columns.

use std::path::Path;

use serde::Serialize;

use super::signals::SignalInfo;
use crate::BagError;
use crate::map::clock_of_table;
use crate::table::{Table, TableFormat, Values};

/// One column.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ColumnInfo {
    /// Name, share without value, and range: in the column's own unit, s since the epoch for dates.
    #[serde(flatten)]
    pub values: SignalInfo,
    /// Unit that the heading gives.
    pub unit: Option<String>,
    /// Whether it has dates.
    pub dates: bool,
    /// Its rows; columns of a MATLAB file may have different lengths.
    pub rows: usize,
}

/// What is in a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TableInfo {
    /// In the order of the file.
    pub columns: Vec<ColumnInfo>,
    /// The column that is taken for the time where nobody says otherwise, and why; or that there is none.
    pub clock: String,
    /// What was not perfect, one line each.
    pub notes: Vec<String>,
}

impl TableInfo {
    /// Summarizes every column of the table at `path`.
    ///
    /// # Errors
    /// Errors of [`Table::read`].
    pub fn read(path: &Path) -> Result<TableInfo, BagError> {
        let table = Table::read(path, &TableFormat::default())?;
        let (clock, reason) = clock_of_table(&table);
        let clock = match clock.column {
            Some(column) => {
                format!("{column}{}: {reason}", clock.unit.map_or(String::new(), |unit| format!(" in {unit}")))
            }
            None => reason,
        };
        let column = |column: crate::table::Column| {
            let numbers = match &column.values {
                Values::Numbers(numbers) => numbers.clone(),
                Values::Stamps(stamps) => stamps.iter().map(|s| s.map_or(f64::NAN, |s| s as f64 / 1e9)).collect(),
            };
            ColumnInfo {
                values: SignalInfo::of(column.name, &numbers),
                unit: column.unit,
                dates: matches!(column.values, Values::Stamps(_)),
                rows: numbers.len(),
            }
        };
        Ok(TableInfo { columns: table.columns.into_iter().map(column).collect(), clock, notes: table.notes })
    }
}
