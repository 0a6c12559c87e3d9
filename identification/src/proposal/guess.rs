//! Quick part of a search for laws: predictions for single terms before any is fitted.

use excavator_model::formula::FormulaText;
use excavator_model::recording::Recording;
use excavator_model::site_name;
use serde::{Deserialize, Serialize};

use super::grammar::law_text;
use super::screening::screen;
use super::shortlist::Shortlist;
use crate::decision::Kind;
use crate::diagnosis::{Diagnosis, DiagnosisSettings};
use crate::fit::{Fit, FitSettings};
use crate::regression::RegressionError;

/// The most promising law of one term. It was neither fitted nor judged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Guess {
    /// The law, with its coefficient after a first step.
    pub text: FormulaText,
    /// Name of its place.
    pub place: String,
    /// Predicted decrease of the loss on the identification recordings; see [`Fit::loss`].
    pub improvement: f64,
}

/// What a fitted model lacks, as the most promising law of one term. Returns `None` if no term promises an improvement.
///
/// # Errors
/// [`RegressionError`] if a recording lacks inputs.
pub fn first_guess(
    given: &Fit,
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &FitSettings,
) -> Result<Option<Guess>, RegressionError> {
    let model = &given.model;
    let screening = screen(model, identification, validation)?;
    let listed = Shortlist::new(model, given.loss(), &screening, identification, settings);
    let first = listed.foretold.first().filter(|first| first.improvement > 0.0).zip(listed.singles.first());
    Ok(first.and_then(|(promised, law)| {
        let text = law_text(&law.terms, "")?;
        let place = site_name(&model.machine, law.site).to_string();
        Some(Guess { text, place, improvement: promised.improvement })
    }))
}

/// The most promising law of one term, if nothing in the catalogue explains the recordings of a diagnosis. Returns
/// `None` for any other verdict, and if a recording lacks the signals of an equation. The verdict then stands without a
/// guess.
pub fn guess_for(diagnosis: &Diagnosis, identification: &[&Recording], validation: &[&Recording]) -> Option<Guess> {
    if diagnosis.verdict.kind != Kind::Unexplained {
        return None;
    }
    let settings = DiagnosisSettings::default().effort.fit;
    first_guess(&diagnosis.supported().fit, identification, validation, &settings).ok().flatten()
}
