//! A verdict and its reasons.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is to be thought of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Verdict")]
pub enum Kind {
    /// An effect of the catalogue is missing (or one of a set that cannot be told apart).
    MissingEffect,
    /// Nothing that matters is missing.
    Adequate,
    /// Something is missing, and it is none of those in the catalogue.
    Unexplained,
}

impl Kind {
    /// Name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Kind::MissingEffect => "missing_effect",
            Kind::Adequate => "adequate",
            Kind::Unexplained => "unexplained",
        }
    }
}

/// The verdict on the scores of a search. Hypotheses are given by their numbers in [`super::Scores::hypotheses`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[must_use]
pub struct Verdict {
    /// What is to be thought of the given model.
    pub kind: Kind,
    /// The hypothesis that the scores favour; 0, the given model, where none is better.
    pub best: usize,
    /// The hypotheses that cannot be told from the best and have no more effects, that one first; empty where the given model is best.
    pub set: Vec<usize>,
    /// Why, the deciding one first.
    pub reasons: Vec<Reason>,
    /// How each hypothesis stands, in the order of the scores.
    pub standings: Vec<Standing>,
}

/// How a hypothesis stands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Standing {
    /// Its log error ratio on the validation recordings.
    pub log_error_ratio: f64,
    /// By how much that is less than the given model's; of a transient effect, which predicts no other recording, the smaller one
    /// of both kinds of recordings.
    pub improvement: f64,
    /// By how much the log error ratio on the identification recordings is less than the given model's.
    pub identification_improvement: f64,
    /// The improvement on all recordings in its own standard errors, from stretch to stretch.
    pub significance: f64,
    /// Whether it could be attributed: each of its effects is needed, shows, and has a sensible size.
    pub is_admissible: bool,
    /// The chance of error at which it leaves the model confidence set; none where it is not admissible.
    pub set_p_value: Option<f64>,
    /// Share of resampled recordings on which it is the best of the admissible ones.
    pub is_first: f64,
}

/// Why a verdict is what it is, with the figures that decided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "reason", rename_all = "snake_case")]
pub enum Reason {
    /// What the given model leaves is the noise of the sensors.
    WithinNoise {
        /// Log error ratio.
        log_error_ratio: f64,
        /// Largest that counts as noise: `noise_margin` of the policy.
        limit: f64,
    },
    /// It is noise but for a few moments.
    ExceptMoments {
        /// Share of the blocks of half a second in which the error is more than twice the noise.
        share_of_time: f64,
    },
    /// What the given model leaves is too small to act on.
    SmallError {
        /// Error beyond the noise, over the signal's variance.
        relative_error: f64,
        /// Largest that is too small to act on: `small_error` of the policy.
        limit: f64,
    },
    /// What the given model leaves is no more than the readings of the inputs leave open.
    WithinInputs {
        /// Log error ratio beyond noise and input readings.
        log_error_ratio: f64,
        /// Largest that counts as noise: `noise_margin` of the policy.
        limit: f64,
    },
    /// The readings of the inputs leave as much open as the given model is off, and that is too much to call it adequate.
    TooCoarse {
        /// Error beyond the noise, over the signal's variance.
        relative_error: f64,
        /// Largest of an adequate model: `largest_error` of the policy.
        limit: f64,
    },
    /// The best hypothesis explains what the given model leaves.
    Explained {
        /// Log error ratio of the given model.
        before: f64,
        /// Log error ratio of the best hypothesis.
        after: f64,
        /// Log error ratio that may remain, or share of `before`: `largest_remainder` of the policy.
        limit: f64,
    },
    /// The best hypothesis explains a part of what the given model leaves, and too much remains for an attribution.
    PartlyExplained {
        /// Log error ratio of the given model.
        before: f64,
        /// Log error ratio of the best hypothesis.
        after: f64,
        /// Log error ratio that may remain, or share of `before`: `largest_remainder` of the policy.
        limit: f64,
    },
    /// No hypothesis improves on the given model.
    NothingHelps {
        /// Log error ratio of the given model.
        log_error_ratio: f64,
    },
    /// The set has more than one hypothesis.
    Indistinguishable {
        /// Their numbers, the best first.
        hypotheses: Vec<usize>,
    },
    /// Each half of the recordings leaves only noise with parameters of its own, and they differ.
    ParametersDrift {
        /// The parameters, the most significant first: their values in the first and in the second half of each recording.
        parameters: Vec<Differing>,
    },
    /// The recordings that were fitted and those that judge leave only noise with parameters of their own, and they differ.
    MachineDiffers {
        /// The parameters, the most significant first: their values where they were fitted, and in those that judge.
        parameters: Vec<Differing>,
    },
    /// A machine that is constructed differently explains the recordings as well or better.
    StructuralAlternative {
        /// The hypothesis with the structural effect.
        hypothesis: usize,
        /// Whether it is better beyond chance.
        is_preferred: bool,
    },
}

impl Reason {
    /// The parameters that differ, if they are the reason.
    pub fn differing(&self) -> Option<&[Differing]> {
        match self {
            Reason::ParametersDrift { parameters } | Reason::MachineDiffers { parameters } => Some(parameters),
            _ => None,
        }
    }
}

/// A parameter with two values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Differing {
    /// Contract name, `arm.coulomb_friction`.
    pub name: String,
    /// What it means.
    pub meaning: String,
    /// SI unit; `-` for a pure number.
    pub unit: String,
    /// Both values, in `unit`.
    pub values: [f64; 2],
    /// Half of the 95 % interval of their difference, in `unit`.
    pub difference_margin_95: f64,
}

impl Verdict {
    /// The parameters that drift over the recordings, or differ between those that were fitted and those that judge, if that is the
    /// reason of the verdict.
    pub fn differing(&self) -> Option<&[Differing]> {
        self.reasons.iter().find_map(Reason::differing)
    }

    /// Whether a structural alternative forbids an attribution.
    pub fn structural_alternative(&self) -> Option<usize> {
        self.reasons.iter().find_map(|reason| match reason {
            Reason::StructuralAlternative { hypothesis, .. } => Some(*hypothesis),
            _ => None,
        })
    }

    /// Whether the recordings are too coarse to act on the verdict.
    pub fn is_too_coarse(&self) -> bool {
        self.reasons.iter().any(|reason| matches!(reason, Reason::TooCoarse { .. }))
    }

    /// The hypothesis whose effects a refinement adds: the best one, unless there is a structural alternative.
    pub fn supported(&self) -> usize {
        if self.structural_alternative().is_some() { 0 } else { self.best }
    }
}
