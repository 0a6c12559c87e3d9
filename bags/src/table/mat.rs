//! Reads MATLAB files of versions 4, 6 and 7 as tables: every real numeric vector is a column.

use rosbag2::{Limit, LimitError, ReadLimits};

use super::fault::TableFault;
use super::{Column, Table, Values, mat4, mat5};

/// A numeric variable.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Variable {
    pub name: String,
    pub rows: usize,
    /// In column-major order; an integer number of columns.
    pub values: Vec<f64>,
}

/// Maximum number of columns read from a matrix; more are of no use.
const COLUMN_LIMIT: usize = 256;

/// Reads the table in a file. `Err` contains the fault in one line.
pub(super) fn parse(bytes: &[u8], limits: &ReadLimits) -> Result<Table, TableFault> {
    let mut table = Table::default();
    let variables = if mat5::is_mat5(bytes) {
        mat5::parse(bytes, &mut table.notes, limits)?
    } else if bytes.get(512..).is_some_and(|rest| rest.starts_with(b"\x89HDF\r\n\x1a\n"))
        || bytes.starts_with(b"\x89HDF")
    {
        return Err("it is a MATLAB 7.3 file (HDF5); save it with `save -v7` to have it read here".into());
    } else {
        mat4::parse(bytes, &mut table.notes, limits)?
    };
    for Variable { name, rows, values } in variables {
        let name = if name.is_empty() { format!("column_{}", table.columns.len() + 1) } else { name };
        let columns = values.len().checked_div(rows).unwrap_or(0);
        // A row vector is treated as a column.
        if rows == 1 || columns == 1 {
            table.columns.push(Column { name, unit: None, values: Values::Numbers(values) });
            continue;
        }
        for (index, column) in values.chunks_exact(rows.max(1)).take(COLUMN_LIMIT).enumerate() {
            let name = format!("{name}[{}]", index + 1);
            table.columns.push(Column { name, unit: None, values: Values::Numbers(column.to_vec()) });
        }
    }
    if table.columns.is_empty() {
        return Err("it has no real numeric variable".into());
    }
    Ok(table)
}

/// The remaining memory for the variables of a file.
pub(super) struct Budget<'l> {
    limits: &'l ReadLimits,
    file_bytes: u64,
    /// Bytes of all values so far.
    values: u64,
    variables: usize,
}

impl<'l> Budget<'l> {
    pub fn new(limits: &'l ReadLimits, file: &[u8]) -> Budget<'l> {
        Budget { limits, file_bytes: file.len() as u64, values: 0, variables: 0 }
    }

    /// Counts a variable with this many values.
    pub fn take(&mut self, values: usize) -> Result<(), LimitError> {
        self.variables += 1;
        Limit::Fields.check(self.variables as u64, self.limits.fields as u64)?;
        // Once for the variable, once more for the columns made from it.
        self.values = self.values.saturating_add(2 * (values as u64).saturating_mul(size_of::<f64>() as u64));
        self.limits.check_memory(self.values, self.file_bytes)
    }

    /// Checks the decompressed size of a variable, in addition to the values so far.
    pub fn unpacks_to(&self, bytes: u64) -> Result<(), LimitError> {
        self.limits.check_memory(self.values.saturating_add(bytes), self.file_bytes)
    }
}

/// The storage types of numbers, common to both formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Number {
    pub fn size(self) -> usize {
        match self {
            Number::I8 | Number::U8 => 1,
            Number::I16 | Number::U16 => 2,
            Number::I32 | Number::U32 | Number::F32 => 4,
            Number::I64 | Number::U64 | Number::F64 => 8,
        }
    }

    /// Decodes all complete numbers in the bytes.
    pub fn read(self, bytes: &[u8], big_endian: bool) -> Vec<f64> {
        macro_rules! read {
            ($type:ty, $convert:expr) => {
                bytes
                    .chunks_exact(self.size())
                    .filter_map(|chunk| chunk.try_into().ok())
                    .map(|chunk| if big_endian { <$type>::from_be_bytes(chunk) } else { <$type>::from_le_bytes(chunk) })
                    .map($convert)
                    .collect()
            };
        }
        match self {
            Number::I8 => read!(i8, f64::from),
            Number::U8 => read!(u8, f64::from),
            Number::I16 => read!(i16, f64::from),
            Number::U16 => read!(u16, f64::from),
            Number::I32 => read!(i32, f64::from),
            Number::U32 => read!(u32, f64::from),
            Number::I64 => read!(i64, |value| value as f64),
            Number::U64 => read!(u64, |value| value as f64),
            Number::F32 => read!(f32, f64::from),
            Number::F64 => read!(f64, |value| value),
        }
    }
}
