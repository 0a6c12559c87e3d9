//! The quick part of a search for laws: what single terms promise, before any is fitted.

use excavator_model::formula::FormulaText;
use excavator_model::recording::Recording;
use excavator_model::site_name;

use super::grammar::law_text;
use super::screening::screen;
use super::shortlist::Shortlist;
use crate::decision::Kind;
use crate::diagnosis::{Diagnosis, DiagnosisSettings};
use crate::fit::{Fit, FitSettings};
use crate::regression::RegressionError;

/// The law of one term that promises most. It was not fitted, and not judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Guess {
    /// The law, its coefficient after a first step.
    pub text: FormulaText,
    /// Name of its place.
    pub place: String,
    /// Fall of the loss of the identification recordings that it promises; see [`Fit::loss`].
    pub improvement: f64,
}

/// What a fitted model lacks, as the law of one term that promises most. `None` where no term promises anything.
///
/// # Errors
/// [`RegressionError`] when a recording lacks inputs.
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

/// Where nothing of the catalogue explains the recordings of a diagnosis: the law of one term that promises most. `None` for any other
/// verdict, and where a recording lacks the signals of an equation: the verdict stands without a guess.
pub fn guess_for(diagnosis: &Diagnosis, identification: &[&Recording], validation: &[&Recording]) -> Option<Guess> {
    if diagnosis.verdict.kind != Kind::Unexplained {
        return None;
    }
    let settings = DiagnosisSettings::default().effort.fit;
    first_guess(&diagnosis.supported().fit, identification, validation, &settings).ok().flatten()
}
