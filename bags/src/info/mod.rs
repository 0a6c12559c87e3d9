//! The signals of a recording or a table, and what they can identify.

mod signals;
mod table;

pub use signals::{EquationInfo, SignalInfo, SignalsInfo, SignalsTally};
pub use table::{ColumnInfo, TableInfo};
