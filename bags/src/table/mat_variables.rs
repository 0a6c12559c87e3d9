//! What both formats of MATLAB files have: variables, the types of their numbers, and the memory that they may take.

use rosbag2::{Limit, LimitError, ReadLimits};

/// A numeric variable.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Variable {
    pub name: String,
    pub rows: usize,
    /// In column-major order; an integer number of columns.
    pub values: Vec<f64>,
}

/// What is in a file.
#[derive(Debug, Default)]
pub(super) struct Content {
    pub variables: Vec<Variable>,
    /// Texts in structs, by the path of their field.
    pub texts: Vec<(String, String)>,
    /// Names of objects, whose content MATLAB alone can read.
    pub objects: Vec<String>,
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
