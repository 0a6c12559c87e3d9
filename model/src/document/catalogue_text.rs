//! A catalogue file: formula effects.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{DocumentError, TomlFault, toml_fault};
use crate::effects::{AnyEffect, Catalogue};
use crate::formula::{FormulaText, Law};

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CatalogueText {
    #[serde(default)]
    formula: Vec<FormulaText>,
}

/// `catalogue` with the formula effects of a catalogue file. `name` is the file's, for messages.
///
/// # Errors
/// [`DocumentError`] in one line that points at the place in the formula.
pub fn parse_catalogue(name: &str, text: &str, catalogue: &Catalogue) -> Result<Catalogue, DocumentError> {
    let parsed: CatalogueText = toml::from_str(text).map_err(|error| {
        let TomlFault { message, excerpt } = toml_fault(text, &error);
        DocumentError::Catalogue { name: name.to_string(), reason: message, excerpt }
    })?;
    if parsed.formula.is_empty() {
        let reason = "it has no [[formula]]".to_string();
        return Err(DocumentError::Catalogue { name: name.to_string(), reason, excerpt: String::new() });
    }
    with_formulas(name, catalogue, &parsed.formula)
}

/// Formula effects as a catalogue file.
///
/// # Errors
/// [`DocumentError::Catalogue`] for a number that TOML does not have.
pub fn catalogue_text(formulas: Vec<FormulaText>) -> Result<String, DocumentError> {
    let unwritable = |error: toml::ser::Error| DocumentError::Catalogue {
        name: "catalogue".to_string(),
        reason: error.to_string(),
        excerpt: String::new(),
    };
    toml::to_string(&CatalogueText { formula: formulas }).map_err(unwritable)
}

/// `catalogue` with these formulas. One that it has already, word for word, is the same effect.
pub(super) fn with_formulas(
    name: &str,
    catalogue: &Catalogue,
    formulas: &[FormulaText],
) -> Result<Catalogue, DocumentError> {
    let inconsistent = |reason: String| DocumentError::Inconsistent { name: name.to_string(), reason };
    let known: std::collections::HashMap<&str, &AnyEffect> =
        catalogue.iter().map(|effect| (&*effect.card().name, effect)).collect();
    let mut new: Vec<AnyEffect> = Vec::new();
    for text in formulas {
        if known.get(text.name.as_str()).is_some_and(|effect| effect.formula() == Some(text)) {
            continue;
        }
        new.push(Arc::new(Law::read(text).map_err(|error| inconsistent(error.to_string()))?));
    }
    catalogue.with(new).map_err(|error| inconsistent(error.to_string()))
}
