//! The layout of a text table.

use serde::{Deserialize, Serialize};

/// How a text table or a sheet is laid out. What is not given is found out.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableFormat {
    /// Sign between columns: `,`, `;`, a tab, or `whitespace`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub delimiter: Option<String>,
    /// Decimal sign of the numbers: `.` or `,`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decimal: Option<char>,
    /// Whether the first line has headings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub header: Option<bool>,
    /// Lines to leave out at the start.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub skip_lines: usize,
    /// Spreadsheets: name of the sheet; without, the first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sheet: Option<String>,
    /// Names of the columns of a table without headings.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<String>,
}

fn is_zero(number: &usize) -> bool {
    *number == 0
}
