//! Reads the values of one column, batch by batch.

use half::f16;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::Result;

use super::kind::Kind;
use crate::table::Values;

/// Number of rows decoded at a time.
const BATCH: usize = 8192;

/// A column read so far.
pub(super) struct Cells {
    kind: Kind,
    /// Definition level of values, see [`batches`].
    level: i16,
    pub values: Values,
    /// Number of instants that do not fit in ns since the epoch.
    pub out_of_range: usize,
}

impl Cells {
    pub fn new(kind: Kind, level: i16) -> Cells {
        let values = match kind {
            Kind::Stamp { .. } => Values::Stamps(Vec::new()),
            _ => Values::Numbers(Vec::new()),
        };
        Cells { kind, level, values, out_of_range: 0 }
    }

    /// Adds one row group and returns its number of rows. Nulls count as not measured.
    pub fn extend(&mut self, reader: ColumnReader, rows: usize) -> Result<usize> {
        let rows = (rows, self.level);
        match reader {
            ColumnReader::BoolColumnReader(reader) => {
                batches(reader, rows, |value| self.number(value.map(|&value| f64::from(u8::from(value)))))
            }
            ColumnReader::Int32ColumnReader(reader) => batches(reader, rows, |value| {
                // Reinterpret the bits of an unsigned number, which may exceed 2^31.
                let unsigned = self.kind == Kind::Number { unsigned: true };
                let whole = |&value: &i32| if unsigned { i64::from(value as u32) } else { i64::from(value) };
                self.integer(value.map(whole));
            }),
            ColumnReader::Int64ColumnReader(reader) => batches(reader, rows, |value| self.integer(value.copied())),
            ColumnReader::Int96ColumnReader(reader) => {
                batches(reader, rows, |value| self.stamp(value.map(|value| Some(value.to_nanos()))))
            }
            ColumnReader::FloatColumnReader(reader) => {
                batches(reader, rows, |value| self.number(value.map(|&value| f64::from(value))))
            }
            ColumnReader::DoubleColumnReader(reader) => batches(reader, rows, |value| self.number(value.copied())),
            ColumnReader::ByteArrayColumnReader(reader) => {
                batches(reader, rows, |value| self.bytes(value.map(|value| value.data())))
            }
            ColumnReader::FixedLenByteArrayColumnReader(reader) => {
                batches(reader, rows, |value| self.bytes(value.map(|value| value.data())))
            }
        }
    }

    fn number(&mut self, value: Option<f64>) {
        if let Values::Numbers(numbers) = &mut self.values {
            numbers.push(value.unwrap_or(f64::NAN));
        }
    }

    /// Adds a stamp: `None` for a null, `Some(None)` for one that is out of range.
    fn stamp(&mut self, value: Option<Option<i64>>) {
        self.out_of_range += usize::from(value == Some(None));
        if let Values::Stamps(stamps) = &mut self.values {
            stamps.push(value.flatten());
        }
    }

    fn integer(&mut self, value: Option<i64>) {
        match self.kind {
            Kind::Stamp { nanoseconds } => self.stamp(value.map(|value| value.checked_mul(nanoseconds))),
            Kind::Decimal { scale } => self.number(value.map(|value| shifted(value as f64, scale))),
            Kind::Number { unsigned: true } => self.number(value.map(|value| value as u64 as f64)),
            _ => self.number(value.map(|value| value as f64)),
        }
    }

    fn bytes(&mut self, value: Option<&[u8]>) {
        let kind = self.kind;
        self.number(value.map(|bytes| match (kind, bytes) {
            (Kind::Half, &[low, high]) => f64::from(f16::from_le_bytes([low, high])),
            (Kind::Decimal { scale }, &[first, ..]) if bytes.len() <= size_of::<i128>() => {
                // Two's complement, most significant byte first.
                let start = if first < 0x80 { 0 } else { -1 };
                shifted(bytes.iter().fold(start, |sum: i128, &byte| sum << 8 | i128::from(byte)) as f64, scale)
            }
            _ => f64::NAN,
        }));
    }
}

/// Shifts the decimal point by `scale` digits.
fn shifted(digits: f64, scale: i32) -> f64 {
    digits / 10_f64.powi(scale)
}

/// Passes each value of `rows` rows to `take`, `None` for nulls; returns the number of rows. Values have the definition
/// level `highest`, which is 0 if nulls are impossible.
fn batches<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    (rows, highest): (usize, i16),
    mut take: impl FnMut(Option<&T::T>),
) -> Result<usize> {
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    let mut read = 0;
    while read < rows {
        levels.clear();
        values.clear();
        let (records, _, _) = reader.read_records(BATCH.min(rows - read), Some(&mut levels), None, &mut values)?;
        if records == 0 {
            break;
        }
        read += records;
        if highest == 0 {
            values.iter().for_each(|value| take(Some(value)));
            continue;
        }
        // Without lists each row has one level, which is the highest if there is a value.
        let mut present = values.iter();
        for &level in &levels {
            take(if level == highest { present.next() } else { None });
        }
    }
    Ok(read)
}
