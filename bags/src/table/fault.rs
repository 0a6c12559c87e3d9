//! Errors when reading a table.

use rosbag2::LimitError;
use thiserror::Error;

/// Why a table cannot be read.
#[derive(Debug, Error)]
pub(super) enum TableFault {
    /// The table exceeds a limit.
    #[error(transparent)]
    Limit(#[from] LimitError),
    /// A read error of the operating system.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// The fault, in one line.
    #[error("{0}")]
    Text(String),
}

impl From<String> for TableFault {
    fn from(reason: String) -> TableFault {
        TableFault::Text(reason)
    }
}

impl From<&str> for TableFault {
    fn from(reason: &str) -> TableFault {
        TableFault::Text(reason.to_string())
    }
}

impl From<csv::Error> for TableFault {
    fn from(error: csv::Error) -> TableFault {
        let text = error.to_string();
        let csv::ErrorKind::Io(error) = error.into_kind() else { return TableFault::Text(text) };
        match error.get_ref().and_then(|inner| inner.downcast_ref::<LimitError>()) {
            Some(limit) => TableFault::Limit(*limit),
            None => TableFault::Io(error),
        }
    }
}
