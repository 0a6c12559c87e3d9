//! Writes model files for machines known by their data sheets: commented text that parses, runs, and can be edited by hand.

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

/// How the source of a number begins that was estimated, because the data sheet does not have it.
pub const ESTIMATE: &str = "start:";

/// Why a model file cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TemplateError {
    /// The data sheet lacks something.
    #[error(transparent)]
    Missing(#[from] MissingFromDataSheet),
    /// The numbers do not define a valid machine.
    #[error(transparent)]
    Document(#[from] DocumentError),
}

/// The model file of a machine with this data sheet. Values that the data sheet lacks are estimated from the size of the machine,
/// for an identification to refine.
///
/// # Errors
/// [`TemplateError`] if a number is missing that cannot be estimated, or if numbers contradict each other.
pub fn model_text(sheet: &DataSheet) -> Result<String, TemplateError> {
    let machine = machine::text(sheet)?;
    let bare = parse(&sheet.name, &machine, &Catalogue::built_in())?;
    let text = format!("{machine}{}", effects::text(sheet, &bare)?);
    parse(&sheet.name, &text, &Catalogue::built_in())?;
    Ok(text)
}
