//! Result of `propose`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Candidate, Parameter, Unexplained, finite};
use crate::decision::Reason;
use crate::proposal::{self, Finding, ProposalVerdict};

/// Proposed laws for what a model is missing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Proposals {
    /// What comes of it.
    pub verdict: ProposalVerdict,
    /// Laws, the best first.
    pub proposals: Vec<Proposal>,
    /// What the given model lacks, as a curve; `null` where its catalogue explains it.
    pub unexplained: Option<Unexplained>,
    /// Rows of the equations in which single terms promise most, as shares of the best.
    pub enters: Vec<Finding>,
    /// Variables without which terms promise less, by the share that is lost.
    pub depends_on: Vec<Finding>,
    /// Effects of the catalogue, and laws, with evidence, the best first.
    pub candidates: Vec<Candidate>,
    /// What decided the verdict, the deciding reason first, with figures.
    pub reasons: Vec<Reason>,
}

/// A law with what it is worth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Proposal {
    /// Name of the law.
    pub name: String,
    /// The row of the equations that it enters: `piston_force`. `excavator effects --language` lists them with their units.
    pub acts_on: String,
    /// Name of its place: a cylinder, `pump` or `machine`.
    pub at: String,
    /// The formula.
    pub formula: String,
    /// Its fitted parameters.
    pub parameters: Vec<Parameter>,
    /// Other effects of the same hypothesis, `effect@place`.
    pub beside: Vec<String>,
    /// Mean NMSE of the given model, refitted, on the validation recordings.
    pub validation_error_before: Option<f64>,
    /// Mean NMSE with the law.
    pub validation_error_after: Option<f64>,
    /// Improvement: fall of the log error ratio on the validation recordings.
    pub evidence: Option<f64>,
    /// Whether the recordings cannot tell it from the first law.
    pub tied_with_first: bool,
    /// Whether it takes energy out of the machine, or none, but never puts any in.
    pub dissipates: bool,
    /// Whether it is a table of the curve, and no law.
    pub is_a_curve: bool,
    /// What speaks against it, one line each.
    pub remarks: Vec<String>,
}

impl Proposals {
    /// Of what a search for laws found.
    pub fn of(found: &proposal::Proposals) -> Self {
        Proposals {
            verdict: found.kind,
            proposals: found.proposals.iter().map(|one| Proposal::of(found, one)).collect(),
            unexplained: found.lacking.as_ref().map(Unexplained::of),
            enters: found.survey.rows.clone(),
            depends_on: found.survey.variables.clone(),
            candidates: Candidate::all(&found.diagnosis),
            reasons: found.diagnosis.verdict.reasons.clone(),
        }
    }
}

impl Proposal {
    fn of(found: &proposal::Proposals, one: &proposal::Proposal) -> Self {
        let is_law = found.kind == ProposalVerdict::Law;
        let first = found.proposals.first().map(|first| first.trial);
        let free = one.effect.parameters.iter().filter(|parameter| !parameter.known);
        Proposal {
            name: one.text.name.clone(),
            acts_on: one.text.acts_on.clone(),
            at: one.place.clone(),
            formula: one.text.formula.clone(),
            parameters: free.map(|parameter| Parameter::named(&parameter.card.name, parameter)).collect(),
            beside: one.beside.clone(),
            validation_error_before: finite(found.error_before),
            validation_error_after: finite(one.validation_error),
            evidence: finite(one.evidence),
            tied_with_first: is_law && one.is_in_set && Some(one.trial) != first,
            dissipates: one.merits.dissipates,
            is_a_curve: one.is_a_curve,
            remarks: one.remarks(),
        }
    }
}
