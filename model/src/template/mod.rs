//! Model files for machines that are known by their data sheets: commented text that reads, runs, and can be changed by hand.

mod data_sheet;
mod effects;
mod examples;
mod machine;

pub use data_sheet::{
    Actuator, CylinderKind, DataSheet, DriveKind, Load, MissingFromDataSheet, RatedFlow, ValveCommand,
};

pub use examples::examples;

use crate::document::{DocumentError, parse};
use crate::effects::Catalogue;

/// Why no model file could be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TemplateError {
    /// The data sheet lacks something.
    #[error(transparent)]
    Missing(#[from] MissingFromDataSheet),
    /// The numbers do not make a machine.
    #[error(transparent)]
    Document(#[from] DocumentError),
}

/// The model file of a machine with this data sheet. What the data sheet does not say is estimated from the size of the machine and is
/// for an identification to find.
///
/// # Errors
/// [`TemplateError`] where a number is missing that nothing can stand in for, or where numbers contradict each other.
pub fn model_text(sheet: &DataSheet) -> Result<String, TemplateError> {
    let machine = machine::text(sheet)?;
    let bare = parse(&sheet.name, &machine, &Catalogue::built_in())?;
    let text = format!("{machine}{}", effects::text(sheet, &bare)?);
    parse(&sheet.name, &text, &Catalogue::built_in())?;
    Ok(text)
}
