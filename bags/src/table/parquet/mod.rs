//! Reads Parquet files as tables: every column of numbers, booleans, dates or times is a column.

mod kind;
mod pages;
mod values;

use bytes::Bytes;
use parquet::errors::ParquetError;
use parquet::file::metadata::ParquetMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use rosbag2::ReadLimits;

use super::fault::TableFault;
use super::{Column, Table, guard, heading};
use kind::Kind;
use values::Cells;

/// Reads the table in a file. `Err` contains the fault in one line.
pub(super) fn parse(bytes: Bytes, limits: &ReadLimits) -> Result<Table, TableFault> {
    if !bytes.starts_with(b"PAR1") {
        return Err("it is not a Parquet file: it does not begin with PAR1".into());
    }
    if !bytes.ends_with(b"PAR1") {
        return Err("the end is missing: a Parquet file can only be read whole".into());
    }
    // The library returns an error for most broken files, but panics on some.
    guard::without_panic(|| read(bytes, limits))
        .unwrap_or_else(|panic| Err(format!("the Parquet file is broken: {panic}").into()))
}

/// A column of the file that becomes a column of the table.
struct Wanted {
    index: usize,
    name: String,
    unit: Option<String>,
    kind: Kind,
    /// Definition level of values.
    level: i16,
}

fn read(bytes: Bytes, limits: &ReadLimits) -> Result<Table, TableFault> {
    let size = bytes.len() as u64;
    let reader = SerializedFileReader::new(bytes.clone()).map_err(|error| broken(&error))?;
    let metadata = reader.metadata();
    let mut table = Table::default();
    let wanted = wanted(metadata, &mut table.notes);
    if wanted.is_empty() {
        return Err("it has no column of numbers".into());
    }
    let rows = rows(metadata)?;
    let values = rows.saturating_mul(wanted.len() as u64);
    limits.check_memory(values.saturating_mul(size_of::<f64>() as u64), size)?;
    if rows == 0 {
        return Err("the table has no rows".into());
    }
    let mut unpacked = 0;
    for group in metadata.row_groups() {
        if group.num_columns() != metadata.file_metadata().schema_descr().num_columns() {
            return Err(format!("the Parquet file is broken: a row group has {} columns", group.num_columns()).into());
        }
        for column in &wanted {
            unpacked = pages::check(&bytes, group.column(column.index), unpacked, limits)
                .map_err(|reason| format!("column {}: {reason}", column.name))?;
        }
    }
    for column in wanted {
        let mut cells = Cells::new(column.kind, column.level);
        for group in 0..metadata.num_row_groups() {
            let reader = reader.get_row_group(group).map_err(|error| broken(&error))?;
            let rows = reader.metadata().num_rows();
            let column_reader = reader.get_column_reader(column.index).map_err(|error| broken(&error))?;
            let read = cells.extend(column_reader, rows as usize).map_err(|error| broken(&error))?;
            if read != rows as usize {
                return Err(format!(
                    "the Parquet file is broken: row group {} has {read} of {rows} rows in column {}",
                    group + 1,
                    column.name
                )
                .into());
            }
        }
        if cells.out_of_range > 0 {
            let (name, count) = (&column.name, cells.out_of_range);
            table
                .notes
                .push(format!("column {name}: {count} times are outside 1677 to 2262 and were taken as not measured"));
        }
        let unit = column.unit.or_else(|| column.kind.unit().map(str::to_string));
        table.columns.push(Column { name: column.name, unit, values: cells.values, times: None });
    }
    Ok(table)
}

/// The supported columns; the others are added to `notes`.
fn wanted(metadata: &ParquetMetaData, notes: &mut Vec<String>) -> Vec<Wanted> {
    let mut wanted = Vec::new();
    for (index, column) in metadata.file_metadata().schema_descr().columns().iter().enumerate() {
        let (name, unit) = heading::split(&column.path().string());
        let name = if name.is_empty() { format!("column_{}", index + 1) } else { name };
        match Kind::of(column) {
            Ok(kind) => wanted.push(Wanted { index, name, unit, kind, level: column.max_def_level() }),
            Err(what) => notes.push(format!("column {name} holds {what} and was left out")),
        }
    }
    wanted
}

/// Number of rows of all row groups.
fn rows(metadata: &ParquetMetaData) -> Result<u64, String> {
    metadata.row_groups().iter().try_fold(0_u64, |sum, group| {
        let rows = group.num_rows();
        let sum = u64::try_from(rows).ok().and_then(|rows| sum.checked_add(rows));
        sum.ok_or_else(|| format!("the Parquet file is broken: a row group has {rows} rows"))
    })
}

fn broken(error: &ParquetError) -> String {
    let text = error.to_string();
    let first = text.lines().next().unwrap_or_default();
    match first.contains("Disabled feature at compile time") {
        true => format!("its compression is not read here ({first}); write it with snappy, zstd, gzip or lz4"),
        false => format!("the Parquet file is broken: {first}"),
    }
}
