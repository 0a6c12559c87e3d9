//! A diagnosis as plain data, which can be stored and read again without the recordings.

use excavator_model::effects::Text;
use excavator_model::equations::Channel;
use excavator_model::{Model, ModelEffect, ModelError, Parameter, addition_name, site_name};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{Diagnosis, Remainder, Share, Unexplained};
use crate::decision::{Policy, Scores, ScoresError, Verdict};
use crate::fit::{Fit, Instrument};
use crate::nullable::finite;
use crate::search::{Addition, Trial, Unpromising};

/// What [`Diagnosis`] holds, without what only a search needs: covariances, and errors that the scores have as well.
///
/// A number that is not finite is `null`, because JSON has no other form for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DiagnosisRecord {
    policy: Policy,
    verdict: Verdict,
    scores: Scores,
    trials: Vec<TrialRecord>,
    unpromising: Vec<UnpromisingRecord>,
    failed: Vec<(String, String)>,
    shares: Vec<(String, Text, [Option<f64>; 2])>,
    remainders: Vec<(String, [Option<f64>; 2], bool)>,
    unexplained: Option<UnexplainedRecord>,
    #[serde(default)]
    lost_messages: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct UnpromisingRecord {
    effect: Text,
    place: String,
    promised_improvement: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct UnexplainedRecord {
    equation: String,
    variable: Text,
    unit: Text,
    share_of_residual: Option<f64>,
    follows_variable: bool,
    differs_in_form: bool,
    curve: Vec<[Option<f64>; 3]>,
}

/// A hypothesis: the effects of its model, in their order, with their parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct TrialRecord {
    additions: Vec<String>,
    effects: Vec<EffectRecord>,
    /// Parameter values on the validation recordings, where transient effects have their own windows.
    values_on_validation: Vec<Option<f64>>,
    fitted: Vec<usize>,
    instruments: Vec<(Channel, f64)>,
    converged: bool,
    seconds: f64,
    error: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct EffectRecord {
    /// `effect@place`.
    name: String,
    parameters: Vec<ParameterRecord>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct ParameterRecord {
    value: Option<f64>,
    standard_error: Option<f64>,
    margin_95: Option<f64>,
    known: bool,
}

/// Why a record is no diagnosis of a model.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// An effect that the model cannot have.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The scores do not agree with themselves.
    #[error(transparent)]
    Scores(#[from] ScoresError),
    /// Parameters that an effect does not have.
    #[error("{effect} has {found} parameters, this program's has {expected}: run the diagnosis again")]
    Parameters {
        /// `effect@place`.
        effect: String,
        /// Number in the record.
        found: usize,
        /// Number in this program.
        expected: usize,
    },
    /// Fewer or more models than scores, or a verdict on a hypothesis that is not there.
    #[error("{trials} models for {hypotheses} hypotheses and {standings} standings: the file is damaged")]
    Shape {
        /// Number of models.
        trials: usize,
        /// Number of scored hypotheses.
        hypotheses: usize,
        /// Number of hypotheses in the verdict.
        standings: usize,
    },
}

fn number(value: Option<f64>) -> f64 {
    value.unwrap_or(f64::NAN)
}

impl DiagnosisRecord {
    /// Of a diagnosis.
    pub fn of(diagnosis: &Diagnosis) -> Self {
        let share = |one: &Share| {
            (one.equation.clone(), one.regime.clone(), [one.share_of_residual, one.share_of_time].map(finite))
        };
        DiagnosisRecord {
            policy: diagnosis.policy,
            verdict: diagnosis.verdict.clone(),
            scores: diagnosis.scores.clone(),
            trials: diagnosis.trials.iter().map(TrialRecord::of).collect(),
            unpromising: diagnosis.unpromising.iter().map(UnpromisingRecord::of).collect(),
            failed: diagnosis.failed.clone(),
            shares: diagnosis.map.iter().map(share).collect(),
            remainders: diagnosis
                .remainders
                .iter()
                .map(|one| (one.equation.clone(), [one.before, one.after].map(finite), one.is_noise))
                .collect(),
            unexplained: diagnosis.unexplained.as_ref().map(|one| UnexplainedRecord {
                equation: one.equation.clone(),
                variable: one.variable.clone(),
                unit: one.unit.clone(),
                share_of_residual: finite(one.share_of_residual),
                follows_variable: one.follows_variable,
                differs_in_form: one.differs_in_form,
                curve: one.curve.iter().map(|point| point.map(finite)).collect(),
            }),
            lost_messages: diagnosis.lost_messages.clone(),
        }
    }

    /// The diagnosis of `given`, whose catalogue has every effect that was tried.
    ///
    /// # Errors
    /// [`RecordError`] if the record does not belong to this model or this version.
    pub fn diagnosis(self, given: &Model) -> Result<Diagnosis, RecordError> {
        let scores = self.scores.checked()?;
        let (trials, hypotheses, standings) =
            (self.trials.len(), scores.hypotheses.len(), self.verdict.standings.len());
        let verdict = &self.verdict;
        let mut named = verdict.set.iter().copied().chain([verdict.best]).chain(verdict.structural_alternative());
        if trials != hypotheses || trials != standings || named.any(|number| number >= trials) {
            return Err(RecordError::Shape { trials, hypotheses, standings });
        }
        let share = |(equation, regime, [share_of_residual, share_of_time]): (_, _, [Option<f64>; 2])| Share {
            equation,
            regime,
            share_of_residual: number(share_of_residual),
            share_of_time: number(share_of_time),
        };
        let remainder = |(equation, [before, after], is_noise): (_, [Option<f64>; 2], _)| Remainder {
            equation,
            before: number(before),
            after: number(after),
            is_noise,
        };
        Ok(Diagnosis {
            policy: self.policy,
            verdict: self.verdict,
            scores,
            trials: self.trials.into_iter().map(|trial| trial.trial(given)).collect::<Result<_, _>>()?,
            unpromising: self.unpromising.into_iter().map(UnpromisingRecord::effect).collect(),
            failed: self.failed,
            map: self.shares.into_iter().map(share).collect(),
            remainders: self.remainders.into_iter().map(remainder).collect(),
            unexplained: self.unexplained.map(|one| Unexplained {
                equation: one.equation,
                variable: one.variable,
                unit: one.unit,
                share_of_residual: number(one.share_of_residual),
                follows_variable: one.follows_variable,
                differs_in_form: one.differs_in_form,
                curve: one.curve.into_iter().map(|point| point.map(number)).collect(),
            }),
            lost_messages: self.lost_messages,
        })
    }
}

impl UnpromisingRecord {
    fn of(one: &Unpromising) -> Self {
        UnpromisingRecord {
            effect: one.effect.clone(),
            place: one.place.clone(),
            promised_improvement: finite(one.promised_improvement),
        }
    }

    fn effect(self) -> Unpromising {
        Unpromising {
            name: addition_name(&self.effect, &self.place),
            effect: self.effect,
            place: self.place,
            promised_improvement: number(self.promised_improvement),
        }
    }
}

impl TrialRecord {
    fn of(trial: &Trial) -> Self {
        let model = &trial.fit.model;
        let parameter = |one: &Parameter| ParameterRecord {
            value: finite(one.value),
            standard_error: one.standard_error.and_then(finite),
            margin_95: one.margin_95.and_then(finite),
            known: one.known,
        };
        let effect = |effect: &ModelEffect| EffectRecord {
            name: addition_name(effect.name(), site_name(&model.machine, effect.site)),
            parameters: effect.parameters.iter().map(parameter).collect(),
        };
        TrialRecord {
            additions: trial.additions.iter().map(|addition| addition.name(model)).collect(),
            effects: model.effects.iter().map(effect).collect(),
            values_on_validation: trial.validation.model.parameter_values().into_iter().map(finite).collect(),
            fitted: trial.fit.fitted.clone(),
            instruments: trial.fit.instruments.iter().map(|one| (one.channel, one.noise)).collect(),
            converged: trial.fit.converged,
            seconds: trial.seconds,
            error: trial.error,
        }
    }

    fn trial(self, given: &Model) -> Result<Trial, RecordError> {
        let mut model = Model { effects: Vec::new(), ..given.clone() };
        for effect in &self.effects {
            model.effects.push(effect.effect(given)?);
        }
        let mut on_validation = model.clone();
        let values: Vec<f64> = self.values_on_validation.iter().copied().map(number).collect();
        if values.len() == on_validation.parameter_values().len() {
            on_validation.set_parameter_values(&values);
        }
        let additions = self.additions.iter().map(|name| addition(given, name)).collect::<Result<_, _>>()?;
        let fit = |model: Model| Fit {
            model,
            fitted: self.fitted.clone(),
            covariance: DMatrix::zeros(0, 0),
            inflation: Vec::new(),
            instruments: self
                .instruments
                .iter()
                .map(|&(channel, noise)| Instrument::new(channel, &given.machine, noise))
                .collect(),
            errors: Vec::new(),
            block_errors: Vec::new(),
            block_places: Vec::new(),
            steps: 0,
            converged: self.converged,
        };
        let (seconds, error) = (self.seconds, self.error);
        Ok(Trial { additions, fit: fit(model), validation: fit(on_validation), seconds, error })
    }
}

impl EffectRecord {
    fn effect(&self, given: &Model) -> Result<ModelEffect, RecordError> {
        let Addition { physics, site } = addition(given, &self.name)?;
        let known = given.effect(&physics.card().name, site).cloned();
        let mut effect = known.map_or_else(|| ModelEffect::new(&physics, &given.machine, site), Ok)?;
        let (found, expected) = (self.parameters.len(), effect.parameters.len());
        if found != expected {
            return Err(RecordError::Parameters { effect: self.name.clone(), found, expected });
        }
        for (own, record) in effect.parameters.iter_mut().zip(&self.parameters) {
            own.value = number(record.value);
            (own.standard_error, own.margin_95, own.known) = (record.standard_error, record.margin_95, record.known);
        }
        Ok(effect)
    }
}

/// The effect that a record calls `effect@place`.
fn addition(given: &Model, name: &str) -> Result<Addition, ModelError> {
    let (physics, site) = given.parse_addition(name)?.swap_remove(0);
    Ok(Addition { physics, site })
}
