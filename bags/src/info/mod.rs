//! Which signals a recording or a table has, and what they are good for.

mod signals;
mod table;

pub use signals::{EquationInfo, SignalInfo, SignalsInfo, SignalsTally};
pub use table::{ColumnInfo, TableInfo};
