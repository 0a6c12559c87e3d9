//! An effect that was tried.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Parameter, finite};
use crate::diagnosis;

/// An effect that was tried, with what it brings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Candidate {
    /// Name in the catalogue.
    pub effect: String,
    /// Name of its place: a cylinder, `pump` or `machine`.
    pub cylinder: String,
    /// Mean NMSE on the validation recordings without it.
    pub validation_error_before: Option<f64>,
    /// Mean NMSE on the validation recordings with it.
    pub validation_error_after: Option<f64>,
    /// Probability that it is there, 0 to 1.
    #[serde(default)]
    pub probability: Option<f64>,
    /// Improvement: fall of the log error ratio on the validation recordings.
    pub evidence: Option<f64>,
    /// Improvement on all recordings in its own standard errors.
    pub significance: Option<f64>,
    /// Chance of error at which its hypothesis leaves the model confidence set; `null` where it is not admissible.
    pub set_p_value: Option<f64>,
    /// What resampled recordings say.
    #[serde(default)]
    pub bootstrap: Bootstrap,
    /// Log error ratio of its hypothesis on the validation recordings: 0 is sensor noise alone.
    pub log_error_ratio: Option<f64>,
    /// Whether it shares the first place with others.
    pub tied_with_first: bool,
    /// Its parameters; of a part of the favoured model, those beside its other parts.
    #[serde(default)]
    pub parameters: Vec<Parameter>,
    /// All parameters that were fitted with it, its own among them.
    #[serde(default)]
    pub refitted: Vec<Parameter>,
}

/// What resampled recordings say of a hypothesis.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Bootstrap {
    /// Share of resampled recordings on which it is the best of the admissible ones, 0 to 1.
    pub is_first: Option<f64>,
}

impl Candidate {
    /// Of a candidate. If it is a part of the favoured model, its parameters are those beside the others, which one alone had to stand in
    /// for.
    fn of(candidate: &diagnosis::Candidate<'_>, diagnosis: &diagnosis::Diagnosis) -> Self {
        let found = &diagnosis.best().fit.model;
        let (alone, site) = (&candidate.trial.fit.model, candidate.addition.site);
        let model = Some(found).filter(|model| model.has(candidate.name(), site)).unwrap_or(alone);
        let standing = candidate.standing;
        Candidate {
            effect: candidate.name().to_string(),
            cylinder: candidate.place().to_string(),
            validation_error_before: candidate.errors[0].and_then(finite),
            validation_error_after: candidate.errors[1].and_then(finite),
            probability: diagnosis.presence_of(candidate).and_then(finite),
            evidence: finite(candidate.improvement),
            significance: finite(standing.significance),
            set_p_value: standing.set_p_value.and_then(finite),
            bootstrap: Bootstrap { is_first: finite(standing.is_first) },
            log_error_ratio: finite(standing.log_error_ratio),
            tied_with_first: candidate.is_tied_with_first,
            parameters: Parameter::of_effect(model, candidate.name(), site),
            refitted: Parameter::of(model, &model.unknown_parameters()),
        }
    }

    /// Those with evidence. A structural alternative is no candidate: a verdict does not name it.
    pub(super) fn all(diagnosis: &diagnosis::Diagnosis) -> Vec<Self> {
        let candidates = diagnosis.candidates().into_iter();
        candidates
            .filter(|one| one.addition.physics.card().family.is_candidate())
            .map(|one| Candidate::of(&one, diagnosis))
            .collect()
    }

    /// Those without.
    pub(super) fn rejected(diagnosis: &diagnosis::Diagnosis) -> Vec<Self> {
        diagnosis.rejected().iter().map(|one| Candidate::of(one, diagnosis)).collect()
    }
}
