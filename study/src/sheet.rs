//! The data sheet of a machine as a file.

use std::collections::BTreeMap;
use std::path::Path;

use excavator_bags::map::SheetColumn;
use rosbag2::{ReadLimits, read_regular_text};
use serde::Deserialize;

use crate::WorkError;

/// A data sheet (TOML): options of `model new` by their names, and what is known of the columns of tables, by heading.
///
/// ```
/// use excavator_study::sheet::Sheet;
///
/// let sheet: Sheet = toml::from_str(
///     r#"
///     drive = "valve"
///     cylinder = "16/10 x 200"
///     slope = 90
///
///     [columns."Position (V)"]
///     signal = "displacement"
///     scale = "20 mm/V"
///     zero = "retracted"
///     "#,
/// )?;
/// assert_eq!(sheet.words(), ["--cylinder=16/10 x 200", "--drive=valve", "--slope=90"]);
/// assert_eq!(sheet.columns.len(), 1);
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Debug, Clone, Default, Deserialize)]
pub struct Sheet {
    /// What the owner says of columns, by heading.
    #[serde(default)]
    pub columns: BTreeMap<String, SheetColumn>,
    /// Options, by name.
    #[serde(flatten)]
    pub options: BTreeMap<String, toml::Value>,
}

impl Sheet {
    /// Reads a file.
    ///
    /// # Errors
    /// [`WorkError::Bag`] if it cannot be read, [`WorkError::SheetSyntax`] if it is not a sheet.
    pub fn read(path: &Path) -> Result<Sheet, WorkError> {
        let text = read_regular_text(path, ReadLimits::DEFAULT.document)?;
        toml::from_str(&text)
            .map_err(|error| WorkError::SheetSyntax { path: path.to_path_buf(), reason: error.message().to_string() })
    }

    /// An option as text; `None` if the sheet does not have it.
    pub fn option(&self, name: &str) -> Option<String> {
        self.options.get(name).map(text)
    }

    /// The options as words of a command line, in the order of their names. An option that is `true` is a word alone; one that is
    /// `false` is none.
    pub fn words(&self) -> Vec<String> {
        let words = self.options.iter().filter_map(|(name, value)| {
            let name = name.replace('_', "-");
            match value {
                toml::Value::Boolean(true) => Some(format!("--{name}")),
                toml::Value::Boolean(false) => None,
                value => Some(format!("--{name}={}", text(value))),
            }
        });
        words.collect()
    }
}

fn text(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
