//! The quick part of a search for laws: what the equations say, before any simulation.

use excavator_model::formula::FormulaText;
use excavator_model::recording::Recording;
use excavator_model::{Model, site_name};

use super::screening::screen;
use super::shortlist::first_of;
use super::term::law_text;
use crate::regression::RegressionError;

/// The law that explains most of what the equations lack. Nothing was simulated with it.
#[derive(Debug, Clone, PartialEq)]
pub struct Guess {
    /// The law, with what a regression says of its numbers.
    pub text: FormulaText,
    /// Name of its place.
    pub place: String,
    /// By how much the logarithm of the likelihood of the equations grows with it, less what the size of the search costs.
    pub evidence: f64,
}

/// What the equations of a fitted model lack, as the law of one term that explains most of it. `None` where no term explains anything.
///
/// # Errors
/// [`RegressionError`] when a recording lacks inputs.
pub fn first_guess(
    model: &Model,
    identification: &[&Recording],
    validation: &[&Recording],
) -> Result<Option<Guess>, RegressionError> {
    let first = first_of(&screen(model, identification, validation)?);
    Ok(first.and_then(|first| {
        let text = law_text(&first.terms, "")?;
        let place = site_name(&model.machine, first.site).to_string();
        Some(Guess { text, place, evidence: first.evidence })
    }))
}
