//! Reads tables: columns of numbers from text files, spreadsheets, MATLAB files and Parquet files.

mod cell;
mod clock_columns;
mod dates;
mod decimal;
mod encoding;
mod fault;
mod format;
#[cfg(feature = "tables")]
mod guard;
#[cfg(feature = "tables")]
mod gzip;
mod head_rows;
mod heading;
mod headings;
mod keyed_lines;
mod layout;
#[cfg(feature = "tables")]
mod mat;
#[cfg(feature = "tables")]
mod mat4;
#[cfg(feature = "tables")]
mod mat5;
#[cfg(feature = "tables")]
mod mat_variables;
#[cfg(feature = "tables")]
mod parquet;
mod sampling;
mod split;
mod text;
mod text_lines;
mod time_cells;
mod time_text;
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
pub(crate) use time_text::FORMS as TIME_FORMS;

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
    /// Index of the column with its times, where the columns of a table have different ones.
    pub times: Option<usize>,
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
    /// Whether the file is a table, according to its extension: `.csv`, `.tsv`, `.tab`, `.txt`, `.dat`, `.lvm`, `.asc`, `.prn`, `.log`,
    /// each also with `.gz`, `.xlsx`, `.xlsm`, `.mat`, `.parquet` or `.pq`.
    pub fn is_table(path: &Path) -> bool {
        let extension = |path: &Path| path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let is_text = |end: &str| TEXTS.contains(&end);
        let is_known = match extension(path).as_deref() {
            Some("gz") => extension(Path::new(path.file_stem().unwrap_or_default())).is_some_and(|end| is_text(&end)),
            Some(end) => is_text(end) || ["xlsx", "xlsm", "mat", "parquet", "pq"].contains(&end),
            None => false,
        };
        is_known && path.is_file()
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

/// Extensions of text tables.
const TEXTS: [&str; 9] = ["csv", "tsv", "tab", "txt", "dat", "lvm", "asc", "prn", "log"];

/// The kinds of tables that are not text, by file extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Packed {
    Gzip,
    Mat,
    Parquet,
    Xlsx,
}

impl Packed {
    /// The kind for the extension; `None` for text.
    fn of(path: &Path) -> Option<Packed> {
        let extension = path.extension()?.to_string_lossy().to_lowercase();
        match extension.as_str() {
            "gz" => Some(Packed::Gzip),
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
            Packed::Gzip => gzip::parse(&whole, format, limits),
            Packed::Mat => mat::parse(&whole, limits),
            Packed::Parquet => parquet::parse(whole.into(), limits),
            Packed::Xlsx => xlsx::parse(whole, format, limits),
        })
    }

    #[cfg(not(feature = "tables"))]
    fn read(self, path: &Path, _: &TableFormat, _: &ReadLimits) -> Result<Result<Table, TableFault>, BagError> {
        let what = match self {
            Packed::Gzip => ".gz",
            Packed::Mat => ".mat",
            Packed::Parquet => ".parquet",
            Packed::Xlsx => ".xlsx",
        };
        Err(rosbag2::Error::NeedsFeature { path: path.to_path_buf(), what, feature: "tables" }.into())
    }
}
