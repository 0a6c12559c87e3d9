//! What is proposed for a case, and whether it holds on a third recording with another manoeuvre.

use std::time::Instant;

use excavator_identification::diagnosis::{DiagnosisError, DiagnosisSettings};
use excavator_identification::fit::{FitSettings, evaluate};
use excavator_identification::proposal::{ProposalVerdict, Proposals, propose};
use excavator_model::Model;
use excavator_model::document::{DocumentError, built_in};
use excavator_model::effects::{AnyEffect, Catalogue};
use excavator_model::recording::Recording;

use crate::cases::{Case, Sort};
use crate::instruments::{Instruments, record};
use crate::manoeuvres::Manoeuvre;
use crate::run::Diverged;
use crate::scoring::Evidence;
use crate::strength::run_and_compare;

/// What was proposed.
#[derive(Debug, Clone)]
pub struct LawScore {
    /// What came of the search.
    pub kind: ProposalVerdict,
    /// The first proposal that is a law, with its numbers.
    pub first: Option<String>,
    /// Other laws that cannot be told from it.
    pub tied: Vec<String>,
    /// Log error ratio on the validation recording, before and with the first proposal.
    pub validation: [f64; 2],
    /// Loss on the third recording, before and with the first proposal.
    pub third: [f64; 2],
    /// Wall-clock time, s.
    pub seconds: f64,
}

/// Why there is none.
#[derive(Debug, thiserror::Error)]
pub enum LawError {
    /// The plant broke.
    #[error(transparent)]
    Plant(#[from] Diverged),
    /// The nominal model cannot be read.
    #[error(transparent)]
    Model(#[from] DocumentError),
    /// The search gave up.
    #[error("the search gave up: {0}")]
    Proposal(#[from] DiagnosisError),
    /// A law cannot be simulated on the third recording.
    #[error("the third recording: {0}")]
    Fit(#[from] excavator_identification::fit::FitError),
}

/// Share of the loss that a law may leave on a recording of a third manoeuvre and still hold.
const LARGEST_REST: f64 = 0.25;

impl LawScore {
    /// Whether what was called a law does not hold where nobody has looked.
    pub fn is_wrong(&self) -> bool {
        let [before, after] = self.third;
        self.kind == ProposalVerdict::Law && after > LARGEST_REST.max(LARGEST_REST * before)
    }

    /// Whether something was proposed where nothing is hidden.
    pub fn is_false_alarm(&self, case: &Case) -> bool {
        case.sort == Sort::Nothing && self.kind != ProposalVerdict::Adequate
    }

    /// In one line.
    pub fn words(&self) -> String {
        let [before, after] = self.validation;
        let [third_before, third_after] = self.third;
        let wrong = if self.is_wrong() { " FAILS ON THE THIRD" } else { "" };
        let mut first = self.first.clone().unwrap_or_default();
        if !self.tied.is_empty() {
            first += &format!("; tied: {}", self.tied.join(" | "));
        }
        format!(
            "{}{wrong}, log error ratio {before:.2} -> {after:.2}, third {third_before:.2} -> {third_after:.2}, {:.1} s: {first}",
            self.kind.name(),
            self.seconds
        )
    }
}

/// Asks for laws; the model and its catalogue have none of the effects in `without`.
///
/// # Errors
/// [`LawError`].
pub fn propose_for(case: &mut Case, evidence: &Evidence, noise: f64, without: &[String]) -> Result<LawScore, LawError> {
    let model = without_effects(&built_in("zx30u-arm")?, without);
    let begin = Instant::now();
    let settings = DiagnosisSettings::default();
    let found = propose(&model, &[&evidence.identification], &[&evidence.validation], &settings, &|_, _| ())?;
    let seconds = begin.elapsed().as_secs_f64();
    let third = third_recording(case, noise)?;
    let first = found.proposals.iter().find(|proposal| !proposal.is_a_curve);
    let trial = first.map_or(found.diagnosis.verdict.best, |first| first.trial);
    let loss = |number: usize| -> Result<f64, LawError> {
        let model = &found.diagnosis.trials[number].fit.model;
        Ok(evaluate(model, &[&third], &FitSettings::default())?.loss())
    };
    let ratio = |number: usize| found.diagnosis.verdict.standings[number].log_error_ratio;
    Ok(LawScore {
        kind: found.kind,
        first: words(&found, trial),
        tied: found
            .proposals
            .iter()
            .filter(|proposal| proposal.is_in_set && proposal.trial != trial)
            .map(|proposal| proposal.text.formula.clone())
            .collect(),
        validation: [ratio(0), ratio(trial)],
        third: [loss(0)?, loss(trial)?],
        seconds,
    })
}

fn words(found: &Proposals, trial: usize) -> Option<String> {
    let best = &found.diagnosis.trials[trial];
    let each: Vec<String> = best
        .additions
        .iter()
        .filter_map(|addition| {
            let effect = best.effect(addition)?;
            let numbers: Vec<String> =
                effect.parameters.iter().map(|one| format!("{} = {:.3e}", one.card.name, one.value)).collect();
            let formula = effect
                .physics
                .formula()
                .map_or(effect.name().to_string(), |text| format!("{}: {}", text.acts_on, text.formula));
            Some(format!("{formula} [{}]", numbers.join(", ")))
        })
        .collect();
    (!each.is_empty()).then(|| each.join(" + "))
}

fn without_effects(model: &Model, names: &[String]) -> Model {
    let mut model = model.clone();
    model.effects.retain(|effect| !names.iter().any(|name| name == effect.name()));
    let left: Vec<AnyEffect> = model
        .catalogue
        .iter()
        .filter(|effect| !names.iter().any(|name| *name == *effect.card().name))
        .cloned()
        .collect();
    model.catalogue = Catalogue::of(left);
    model
}

/// The machine in a third manoeuvre.
fn third_recording(case: &mut Case, noise: f64) -> Result<Recording, Diverged> {
    let plant = case.plant;
    let manoeuvre = Manoeuvre { firmness: case.validation.firmness, ..Manoeuvre::third(case.validation.centre) };
    let (truth, _) = run_and_compare(&plant, &manoeuvre, case.begin[0])?;
    let instruments = Instruments { noise, spool_sensor: !plant.blind_spool, ..Instruments::default() };
    let name = format!("case {} third", case.number);
    Ok(record(&truth, &plant.effects.sensors, &plant.extras, &instruments, &name, &mut case.generator))
}
