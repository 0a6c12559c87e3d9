//! What the diagnosis says of a case, and whether it is right.

use std::time::Instant;

use excavator_identification::decision::Scores;
use excavator_identification::diagnosis::{Diagnosis, DiagnosisError, DiagnosisSettings, diagnose};
use excavator_identification::fit::normalised_error;
use excavator_model::Model;
use excavator_model::document::{DocumentError, built_in};
use excavator_model::recording::Recording;
use serde::{Deserialize, Serialize};

use crate::answer::{Answer, Outcome};
use crate::cases::{Case, Sort};
use crate::instruments::{Instruments, record};
use crate::run::Diverged;
use crate::strength::{Change, run_and_compare};

/// The diagnosis of one case.
#[derive(Debug, Clone)]
pub struct Score {
    /// What was said.
    pub answer: Answer,
    /// Against the secret.
    pub outcome: Outcome,
    /// Median relative error of the hidden effects' parameters that the catalogue knows by name.
    pub coefficient_error: Option<f64>,
    /// Mean NMSE over instruments on validation, before anything is added and after.
    pub nmse: [f64; 2],
    /// Base parameters of the last model that have an interval.
    pub estimates: Vec<Estimate>,
    /// Wall-clock time of the diagnosis, s.
    pub seconds: f64,
    /// What the verdict was decided from.
    pub scores: Scores,
}

/// A base parameter of the last model against the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// As the model calls it.
    pub name: &'static str,
    /// Error over the true value.
    pub relative_error: f64,
    /// Error over the standard error.
    pub standardised_error: f64,
}

impl Estimate {
    /// Whether the 95 % interval holds the truth.
    pub fn is_covered(&self) -> bool {
        self.standardised_error.abs() <= 1.96
    }
}

/// Two recordings of a case, with how much is hidden in them.
#[derive(Debug, Clone)]
pub struct Evidence {
    /// For identification.
    pub identification: Recording,
    /// For validation.
    pub validation: Recording,
    /// What the effects change, in identification and validation.
    pub change: [Change; 2],
}

/// Why a case has no score.
#[derive(Debug, thiserror::Error)]
pub enum ScoreError {
    /// The plant broke.
    #[error(transparent)]
    Plant(#[from] Diverged),
    /// The nominal model cannot be read.
    #[error(transparent)]
    Model(#[from] DocumentError),
    /// The diagnosis gave up.
    #[error("the diagnosis gave up: {0}")]
    Diagnosis(#[from] DiagnosisError),
}

/// Runs and records a case. A case that hides what the spool does has no spool sensor.
///
/// # Errors
/// [`Diverged`].
pub fn make(case: &mut Case, instruments: &Instruments) -> Result<Evidence, Diverged> {
    let instruments = Instruments { spool_sensor: instruments.spool_sensor && !case.plant.blind_spool, ..*instruments };
    let (plant, name) = (case.plant, format!("case {}", case.number));
    let (first, first_change) = run_and_compare(&plant, &case.identification, case.begin[0])?;
    let (second, second_change) = run_and_compare(&plant, &case.validation, case.begin[1])?;
    let sensors = &plant.effects.sensors;
    let generator = &mut case.generator;
    Ok(Evidence {
        identification: record(
            &first,
            sensors,
            &plant.extras,
            &instruments,
            &format!("{name} identification"),
            generator,
        ),
        validation: record(&second, sensors, &plant.extras, &instruments, &format!("{name} validation"), generator),
        change: [first_change, second_change],
    })
}

/// Asks the diagnosis and compares.
///
/// # Errors
/// [`ScoreError`].
pub fn score(case: &Case, evidence: &Evidence) -> Result<Score, ScoreError> {
    let model = built_in("zx30u-arm")?;
    let begin = Instant::now();
    let settings = DiagnosisSettings::default();
    let diagnosis = diagnose(&model, &[&evidence.identification], &[&evidence.validation], &settings, &|_, _| ())?;
    let seconds = begin.elapsed().as_secs_f64();
    let answer = Answer::of(&diagnosis.scores, &diagnosis.verdict);
    let error =
        |trial: &excavator_identification::search::Trial| normalised_error(&trial.validation, &[&evidence.validation]);
    Ok(Score {
        outcome: answer.against(&Secret::of(case)),
        coefficient_error: coefficient_error(case, &diagnosis),
        nmse: [error(diagnosis.given()), error(diagnosis.supported())],
        estimates: estimates(case, &diagnosis.supported().fit.model),
        seconds,
        answer,
        scores: diagnosis.scores,
    })
}

/// What a case hides, as far as an answer is compared with it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Secret {
    /// What sort of secret, as far as it can be seen.
    pub sort: Sort,
    /// Names that an answer should have.
    pub effects: Vec<String>,
    /// The secret and its strength in words.
    pub words: String,
}

impl Secret {
    /// Of a case.
    pub fn of(case: &Case) -> Self {
        let is_visible = case.hidden.iter().all(|kind| kind.identifiable);
        Secret {
            sort: if is_visible { case.sort } else { Sort::Nothing },
            effects: case.nameable().map(|kind| kind.answer.to_string()).collect(),
            words: format!("{} {}", case.secret(), case.strength.name()),
        }
    }
}

/// Of the hidden effects' parameters, in the favoured model and in the candidates that bear their names.
fn coefficient_error(case: &Case, diagnosis: &Diagnosis) -> Option<f64> {
    let candidates = diagnosis.candidates();
    let named = candidates.iter().filter(|one| case.hidden.iter().any(|kind| kind.answer == one.name()));
    let models: Vec<&Model> =
        std::iter::once(&diagnosis.best().fit.model).chain(named.map(|one| &one.trial.fit.model)).collect();
    let error = |(name, truth): (&str, f64)| {
        let value = models.iter().find_map(|model| model.value_of(name))?;
        Some((value / truth - 1.0).abs())
    };
    let mut errors: Vec<f64> = case.truth().into_iter().filter_map(error).collect();
    median(&mut errors)
}

fn estimates(case: &Case, model: &Model) -> Vec<Estimate> {
    let names = model.parameter_names();
    let estimate = |(name, truth): (&'static str, f64)| {
        let index = names.iter().position(|candidate| candidate == name)?;
        let (_, parameter) = model.parameters().nth(index)?;
        let standard_error = parameter.standard_error?;
        let error = parameter.value - truth;
        Some(Estimate { name, relative_error: error / truth, standardised_error: error / standard_error })
    };
    case.plant.base.named().into_iter().filter_map(estimate).collect()
}

/// Middle value; `None` of nothing.
pub fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let upper = *values.get(values.len() / 2)?;
    if values.len() % 2 == 1 {
        return Some(upper);
    }
    Some((values[values.len() / 2 - 1] + upper) / 2.0)
}
