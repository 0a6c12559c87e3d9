//! What the diagnosis says of a case, and whether it is right.

use std::time::Instant;

use excavator_identification::diagnosis::{Diagnosis, DiagnosisError, DiagnosisSettings, Verdict, diagnose};
use excavator_identification::fit::Fit;
use excavator_model::Model;
use excavator_model::document::{DocumentError, built_in};
use excavator_model::recording::Recording;

use crate::cases::{Case, Sort};
use crate::instruments::{Instruments, record};
use crate::run::Diverged;
use crate::strength::{Change, run_and_compare};

/// How the answer compares with the secret.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The right verdict, and the right name alone.
    Right,
    /// The right name in a tied set.
    Tied,
    /// One of two names.
    Partial,
    /// Something was found, under a wrong name.
    WrongName,
    /// A catalogue effect was found, and called unexplained.
    CalledUnexplained,
    /// Something is hidden, and nothing was found.
    Missed,
    /// Nothing can be seen, and something was found.
    FalseAlarm,
}

impl Outcome {
    /// Name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::Right => "right",
            Outcome::Tied => "right, tied",
            Outcome::Partial => "one of two",
            Outcome::WrongName => "WRONG NAME",
            Outcome::CalledUnexplained => "called unexplained",
            Outcome::Missed => "MISSED",
            Outcome::FalseAlarm => "FALSE ALARM",
        }
    }
}

/// The diagnosis of one case.
#[derive(Debug, Clone)]
pub struct Score {
    /// Verdict.
    pub verdict: Verdict,
    /// Name of the first candidate with evidence.
    pub first: Option<&'static str>,
    /// Names tied with it, itself included.
    pub tied: Vec<&'static str>,
    /// Names added one after the other.
    pub chain: Vec<&'static str>,
    /// Against the secret.
    pub outcome: Outcome,
    /// Median relative error of the hidden effects' parameters that the catalogue knows by name.
    pub coefficient_error: Option<f64>,
    /// Mean NMSE over instruments on validation, before anything is added and after.
    pub nmse: [f64; 2],
    /// Loss on validation: of the nominal model, then after each effect of the chain; 0 is sensor noise alone.
    pub losses: Vec<f64>,
    /// The same but for the worst moments, before anything is added and after.
    pub typical: [f64; 2],
    /// Name, gain and significance of the best candidates for the first place.
    pub gains: Vec<(&'static str, f64, f64)>,
    /// Base parameters of the last model that have an interval.
    pub estimates: Vec<Estimate>,
    /// Wall-clock time of the diagnosis, s.
    pub seconds: f64,
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

/// Runs and records a case, with a factor on all sensor noise and a spool sensor that is `spool_lead` s ahead.
///
/// # Errors
/// [`Diverged`].
pub fn make(case: &mut Case, noise: f64, spool_lead: f64) -> Result<Evidence, Diverged> {
    let instruments = Instruments { noise, spool_sensor: !case.plant.blind_spool, spool_lead };
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
    let first = diagnosis.candidates.first().map(|candidate| candidate.name());
    let tied = diagnosis.candidates.iter().filter(|candidate| candidate.tied_with_first);
    let tied: Vec<&'static str> = tied.map(|candidate| candidate.name()).collect();
    let chain: Vec<&'static str> = diagnosis.chain.iter().map(|candidate| candidate.name()).collect();
    let hidden: Vec<&'static str> = case.hidden.iter().map(|kind| kind.answer).collect();
    let visible = case.hidden.iter().all(|kind| kind.identifiable);
    let sort = if visible { case.sort } else { Sort::Nothing };
    let (last, last_validation) = last_fit(&diagnosis);
    Ok(Score {
        outcome: outcome(sort, diagnosis.verdict, &hidden, &tied, &chain, first),
        coefficient_error: coefficient_error(case, &diagnosis),
        nmse: [nmse(&diagnosis.nominal_validation, evidence), nmse(last_validation, evidence)],
        losses: std::iter::once(&diagnosis.nominal_validation)
            .chain(diagnosis.chain.iter().map(|step| &step.validation))
            .map(Fit::loss)
            .collect(),
        typical: [diagnosis.nominal_validation.typical_loss(), last_validation.typical_loss()],
        gains: diagnosis
            .candidates
            .iter()
            .chain(&diagnosis.rejected)
            .take(3)
            .map(|candidate| (candidate.name(), candidate.evidence.gain, candidate.evidence.significance))
            .collect(),
        estimates: estimates(case, &last.model),
        verdict: diagnosis.verdict,
        first,
        tied,
        chain,
        seconds,
    })
}

/// Judges an answer. `tied` names the set that shares the first place (empty when it is alone), `chain` what was added.
pub fn outcome(
    sort: Sort,
    verdict: Verdict,
    hidden: &[&str],
    tied: &[&str],
    chain: &[&str],
    first: Option<&str>,
) -> Outcome {
    let found = |name: &&str| first == Some(*name) || tied.contains(name) || chain.contains(name);
    match (sort, verdict) {
        (Sort::Nothing, Verdict::Adequate) | (Sort::Unknown, Verdict::Unexplained) => Outcome::Right,
        (Sort::Nothing, _) => Outcome::FalseAlarm,
        (_, Verdict::Adequate) => Outcome::Missed,
        (Sort::Unknown, Verdict::MissingEffect) => Outcome::WrongName,
        (_, Verdict::Unexplained) => Outcome::CalledUnexplained,
        (Sort::Single, _) => match hidden.first() {
            Some(name) if first == Some(*name) && tied.is_empty() => Outcome::Right,
            Some(name) if first == Some(*name) || tied.contains(name) => Outcome::Tied,
            _ => Outcome::WrongName,
        },
        (Sort::Pair, _) => match hidden.iter().filter(|name| found(name)).count() {
            0 => Outcome::WrongName,
            number if number == hidden.len() => Outcome::Right,
            _ => Outcome::Partial,
        },
    }
}

fn last_fit(diagnosis: &Diagnosis) -> (&Fit, &Fit) {
    let nominal = (&diagnosis.nominal, &diagnosis.nominal_validation);
    diagnosis.chain.last().map_or(nominal, |last| (&last.fit, &last.validation))
}

/// Mean over instruments of squared error over the signal's variance on validation.
fn nmse(fit: &Fit, evidence: &Evidence) -> f64 {
    let each: Vec<f64> = fit
        .instruments
        .iter()
        .zip(&fit.errors)
        .filter_map(|(instrument, error)| {
            let signal = evidence.validation.signal(&instrument.name)?;
            let count = signal.len() as f64;
            let mean = signal.iter().sum::<f64>() / count;
            let variance = signal.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
            (variance > 0.0).then(|| error * error / variance)
        })
        .collect();
    each.iter().sum::<f64>() / each.len() as f64
}

/// Of the hidden effects' parameters, in the candidates that bear their names.
fn coefficient_error(case: &Case, diagnosis: &Diagnosis) -> Option<f64> {
    let models: Vec<&Model> = diagnosis
        .chain
        .last()
        .into_iter()
        .chain(&diagnosis.candidates)
        .filter(|candidate| case.hidden.iter().any(|kind| kind.answer == candidate.name()))
        .map(|candidate| &candidate.fit.model)
        .collect();
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
