//! What effects that somebody named do for a model.

use excavator_model::effects::{Effect, Site};
use excavator_model::recording::Recording;

use super::adequacy::adequacy_as_given;
use super::candidate::CandidateError;
use super::chain::Chains;
use super::own_windows::evaluate_in_own_windows;
use super::{Candidate, DiagnosisSettings, Evidence, Verdict, compare_losses};
use crate::fit::{Fit, evaluate};

/// What is to be thought of effects that were added because somebody named them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedVerdict {
    /// `MissingEffect` where they explain what the model was missing, `Adequate` where it was missing nothing, `Unexplained`
    /// where something is missing still.
    pub verdict: Verdict,
    /// What they gained together on the validation recordings.
    pub evidence: Evidence,
    /// Whether that is more than chance and the small errors that every model has.
    pub helps: bool,
}

/// Judges effects that were added to `nominal` one after the other, each given with its place and the fit that ends with it, by the
/// rules that a diagnosis has for its own.
///
/// # Errors
/// [`CandidateError`] when a model cannot be evaluated on the validation recordings.
pub(crate) fn judge_named(
    nominal: &Fit,
    added: &[(&'static dyn Effect, Site, Fit)],
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &DiagnosisSettings,
) -> Result<NamedVerdict, CandidateError> {
    let nominal_validation = evaluate(&nominal.model, validation, &settings.fit)?;
    let (adequacy, _) = adequacy_as_given(&nominal_validation, validation, settings);
    let mut chain: Vec<Candidate> = Vec::new();
    for (physics, site, fit) in added {
        let (base, base_validation) =
            chain.last().map_or((nominal, &nominal_validation), |last| (&last.fit, &last.validation));
        let evaluated = evaluate_in_own_windows(&fit.model, &base_validation.model, validation, &settings.fit)?;
        chain.push(Candidate::new(*physics, *site, [fit.clone(), evaluated], [base, base_validation]));
    }
    let chains = Chains {
        nominal,
        nominal_validation: &nominal_validation,
        nominal_is_adequate: adequacy.is_some(),
        identification,
        validation,
        settings,
    };
    let last = chain.last().map_or(&nominal_validation, |last| &last.validation);
    let evidence = compare_losses(&nominal_validation, last);
    let least_gain = if adequacy.is_some() { settings.least_gain_when_adequate } else { settings.least_gain };
    let helps = evidence.gain >= least_gain && evidence.significance >= settings.least_significance;
    let verdict = if helps && chains.explains(&chain) {
        Verdict::MissingEffect
    } else if adequacy.is_some() {
        Verdict::Adequate
    } else {
        Verdict::Unexplained
    };
    Ok(NamedVerdict { verdict, evidence, helps })
}
