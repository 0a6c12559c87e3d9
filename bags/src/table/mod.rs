//! Reads tables: columns of numbers from text files, spreadsheets, MATLAB files and Parquet files.

mod cell;
mod dates;
mod fault;
mod format;
#[cfg(feature = "tables")]
mod guard;
mod heading;
#[cfg(feature = "tables")]
mod mat;
#[cfg(feature = "tables")]
mod mat4;
#[cfg(feature = "tables")]
mod mat5;
#[cfg(feature = "tables")]
mod parquet;
mod preamble;
mod sampling;
mod text;
mod text_lines;
#[cfg(feature = "tables")]
mod xlsx;

use std::io::Cursor;
use std::path::Path;

#[cfg(feature = "tables")]
use rosbag2::read_regular;
use rosbag2::{ReadLimits, open_regular};

use crate::BagError;
use fault::TableFault;

pub use dates::parse_date;
pub use format::TableFormat;
pub(crate) use heading::split as heading_of;
pub use sampling::Sampling;

/// The values of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers as written; `NaN` for empty cells and nulls.
    Numbers(Vec<f64>),
    /// Dates, ns since the epoch; `None` for empty cells and nulls.
    Stamps(Vec<Option<i64>>),
}

impl Values {
    /// Number of rows.
    pub fn len(&self) -> usize {
        match self {
            Values::Numbers(values) => values.len(),
            Values::Stamps(stamps) => stamps.len(),
        }
    }

    /// Whether the column has no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// One column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Heading without its unit, or name of the variable; `column_3` without a heading.
    pub name: String,
    /// Unit in the heading, otherwise the one that every cell has, if it is known.
    pub unit: Option<String>,
    /// The values.
    pub values: Values,
}

/// A table.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// In the order of the file. Columns of a MATLAB file may have different lengths.
    pub columns: Vec<Column>,
    /// Sampling rate, if a line before the table gives it.
    pub sampling: Option<Sampling>,
    /// Imperfections, one line each.
    pub notes: Vec<String>,
}

impl Table {
    /// Whether the file is a table, according to its extension: `.csv`, `.tsv`, `.txt`, `.dat`, `.xlsx`, `.xlsm`,
    /// `.mat`, `.parquet` or `.pq`.
    pub fn is_table(path: &Path) -> bool {
        let ends = ["csv", "tsv", "txt", "dat", "xlsx", "xlsm", "mat", "parquet", "pq"];
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        path.is_file() && extension.is_some_and(|end| ends.contains(&end.as_str()))
    }

    /// Reads a table.
    ///
    /// # Errors
    /// [`rosbag2::Error::Io`], [`rosbag2::Error::NotARegularFile`], [`BagError::BadTable`], [`rosbag2::Error::Limit`];
    /// [`rosbag2::Error::NeedsFeature`] for a spreadsheet, MATLAB or Parquet file without the feature `tables`.
    pub fn read(path: &Path, format: &TableFormat) -> Result<Table, BagError> {
        Table::read_within(path, format, &ReadLimits::DEFAULT)
    }

    /// As [`Table::read`], with other limits.
    ///
    /// # Errors
    /// As [`Table::read`].
    pub fn read_within(path: &Path, format: &TableFormat, limits: &ReadLimits) -> Result<Table, BagError> {
        let table = match Packed::of(path) {
            Some(packed) => packed.read(path, format, limits)?,
            None => {
                let (mut file, length) = open_regular(path)?;
                text::parse(&mut file, length, format, limits)
            }
        };
        table.map_err(|fault| match fault {
            TableFault::Limit(source) => rosbag2::Error::Limit { path: path.to_path_buf(), source }.into(),
            TableFault::Io(error) => rosbag2::Error::io("read", path)(error).into(),
            TableFault::Text(reason) => BagError::BadTable { path: path.to_path_buf(), reason },
        })
    }

    /// Parses the text of a CSV file of any dialect.
    ///
    /// ```
    /// use excavator_bags::table::{Table, TableFormat, Values};
    ///
    /// let table = Table::from_text(b"t [s],p [bar]\n0,1.5\n0.5,-2.25\n1.0,3e2\n", &TableFormat::default())?;
    /// assert_eq!((table.columns[1].name.as_str(), table.columns[1].unit.as_deref()), ("p", Some("bar")));
    /// assert_eq!(table.columns[1].values, Values::Numbers(vec![1.5, -2.25, 300.0]));
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// The fault, in one line.
    pub fn from_text(bytes: &[u8], format: &TableFormat) -> Result<Table, String> {
        text::parse(&mut Cursor::new(bytes), bytes.len() as u64, format, &ReadLimits::DEFAULT)
            .map_err(|fault| fault.to_string())
    }

    /// Reads a MATLAB file of version 4, 6 or 7.
    ///
    /// # Errors
    /// The fault, in one line.
    #[cfg(feature = "tables")]
    pub fn from_mat(bytes: &[u8]) -> Result<Table, String> {
        mat::parse(bytes, &ReadLimits::DEFAULT).map_err(|fault| fault.to_string())
    }

    /// Reads a sheet of a spreadsheet.
    ///
    /// # Errors
    /// The fault, in one line.
    #[cfg(feature = "tables")]
    pub fn from_xlsx(bytes: Vec<u8>, format: &TableFormat) -> Result<Table, String> {
        xlsx::parse(bytes, format, &ReadLimits::DEFAULT).map_err(|fault| fault.to_string())
    }

    /// Reads a Parquet file.
    ///
    /// # Errors
    /// The fault, in one line.
    #[cfg(feature = "tables")]
    pub fn from_parquet(bytes: Vec<u8>) -> Result<Table, String> {
        parquet::parse(bytes.into(), &ReadLimits::DEFAULT).map_err(|fault| fault.to_string())
    }
}

/// The kinds of tables that are not text, by file extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Packed {
    Mat,
    Parquet,
    Xlsx,
}

impl Packed {
    /// The kind for the extension; `None` for text.
    fn of(path: &Path) -> Option<Packed> {
        let extension = path.extension()?.to_string_lossy().to_lowercase();
        match extension.as_str() {
            "mat" => Some(Packed::Mat),
            "parquet" | "pq" => Some(Packed::Parquet),
            "xlsx" | "xlsm" => Some(Packed::Xlsx),
            _ => None,
        }
    }

    #[cfg(feature = "tables")]
    fn read(
        self,
        path: &Path,
        format: &TableFormat,
        limits: &ReadLimits,
    ) -> Result<Result<Table, TableFault>, BagError> {
        // A file that is held in memory as a whole may be as large as its values.
        let whole = read_regular(path, limits.memory)?;
        Ok(match self {
            Packed::Mat => mat::parse(&whole, limits),
            Packed::Parquet => parquet::parse(whole.into(), limits),
            Packed::Xlsx => xlsx::parse(whole, format, limits),
        })
    }

    #[cfg(not(feature = "tables"))]
    fn read(self, path: &Path, _: &TableFormat, _: &ReadLimits) -> Result<Result<Table, TableFault>, BagError> {
        let what = match self {
            Packed::Mat => ".mat",
            Packed::Parquet => ".parquet",
            Packed::Xlsx => ".xlsx",
        };
        Err(rosbag2::Error::NeedsFeature { path: path.to_path_buf(), what, feature: "tables" }.into())
    }
}
