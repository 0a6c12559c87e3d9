//! Result of `diagnose`.

use excavator_model::{Model, site_name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Candidate, Guess, MissingPower, Parameter, RecordingLedger, Unexplained, finite};
use crate::decision::{Kind, Reason};
use crate::fit::nuisances_shown;
use crate::{diagnosis, energy, proposal};

/// What a model is missing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Diagnosis {
    /// What is to be thought of the given model.
    pub verdict: Kind,
    /// What decided it, the deciding reason first, with figures.
    #[serde(default)]
    pub reasons: Vec<Reason>,
    /// Mean NMSE on the validation recordings, simulated from their starts.
    #[serde(default)]
    pub validation_error: ErrorChange,
    /// Effects with evidence, the best first.
    pub candidates: Vec<Candidate>,
    /// Effects without evidence.
    #[serde(default)]
    pub rejected: Vec<Candidate>,
    /// The effects that the verdict supports, one after the other, in the model that has them all.
    #[serde(default)]
    pub effects: Vec<SelectedEffect>,
    /// What is left with these effects, in the balance that leaves most; `null` if that is noise.
    pub remains: Option<Remains>,
    /// Effects of instruments and recording that were estimated and show.
    #[serde(default)]
    pub nuisances: Vec<Nuisance>,
    /// What is left in each balance on the validation recordings, the largest first.
    #[serde(default)]
    pub balances: Vec<diagnosis::Remainder>,
    /// Where the residual of the given model is, the largest share first.
    #[serde(default, rename = "where")]
    pub shares: Vec<ResidualShare>,
    /// What remains where nothing explains it, as a curve; `null` for other verdicts.
    pub unexplained: Option<Unexplained>,
    /// A machine that is constructed differently and explains the recordings as well; `null` where there is none.
    pub construction: Option<Construction>,
    /// Whether the readings of the inputs are too coarse to act on the verdict.
    #[serde(default)]
    pub too_coarse: bool,
    /// Log error ratio of the given model on the validation recordings: 0 is sensor noise alone, 0.7 is twice its variance everywhere.
    pub log_error_ratio: Option<f64>,
    /// Parameters of the given model, fitted again.
    #[serde(default)]
    pub refitted: Vec<Parameter>,
    /// Sensors that the model was compared with.
    #[serde(default)]
    pub instruments: Vec<Instrument>,
    /// For the verdict `unexplained`: the law of one term that promises most; else `null`.
    pub first_guess: Option<Guess>,
    /// What the energy ledger of the refitted model misses, for each validation recording in which energy is known.
    #[serde(default)]
    pub missing_power: Vec<RecordingLedger>,
    /// Messages that the recordings rest on and that were lost while they were recorded, one line each.
    #[serde(default)]
    pub lost_messages: Vec<String>,
}

/// An error before and after additions.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ErrorChange {
    /// Of the given model, refitted.
    pub before: Option<f64>,
    /// Of the model that the verdict supports.
    pub after: Option<f64>,
}

/// An effect that the verdict supports.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct SelectedEffect {
    /// Name in the catalogue.
    pub effect: String,
    /// Name of its place: a cylinder, `pump` or `machine`.
    pub cylinder: String,
    /// Probability that it is there, 0 to 1.
    #[serde(default)]
    pub probability: Option<f64>,
    /// Log error ratio on the validation recordings of the hypothesis that ends with it.
    pub log_error_ratio_after: Option<f64>,
    /// Its parameters in the model that has all of them.
    pub parameters: Vec<Parameter>,
}

/// An effect of instruments or recording that was estimated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Nuisance {
    /// Name in the catalogue.
    pub effect: String,
    /// Name of its place: a cylinder, `pump` or `machine`.
    pub cylinder: String,
    /// Its parameters.
    #[serde(default)]
    pub parameters: Vec<Parameter>,
}

/// What is left in the balance that leaves most.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Remains {
    /// Name of the equation: `arm.motion`.
    pub balance: String,
    /// Mean squared residual over that of the given model.
    pub share: Option<f64>,
}

/// Share of the residual in one equation under one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ResidualShare {
    /// Name of the equation: `arm.motion`.
    pub equation: String,
    /// The condition in words: `valve closed`, `to cap side, fast`.
    pub regime: String,
    /// Share of the squared residual of all equations, in units of noise, 0 to 1.
    pub share_of_residual: Option<f64>,
    /// Share of the time, 0 to 1.
    pub share_of_time: Option<f64>,
}

/// A structural alternative: a property of the machine's design that is never attributed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Construction {
    /// Name in the catalogue.
    pub effect: String,
    /// Name of its place: a cylinder, `pump` or `machine`.
    pub cylinder: String,
    /// Mean NMSE on the validation recordings with it.
    pub validation_error_after: Option<f64>,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

/// A sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Instrument {
    /// Contract name of its signal: `arm.displacement`.
    pub name: String,
    /// Standard deviation of its noise, in `unit`.
    pub noise: Option<f64>,
    /// SI unit.
    #[serde(default)]
    pub unit: String,
}

impl Diagnosis {
    /// Of a diagnosis of the model `given`, with the guess that goes with it and the ledgers of its validation recordings.
    pub fn of(
        given: &Model,
        diagnosis: &diagnosis::Diagnosis,
        guess: Option<&proposal::Guess>,
        ledgers: &[(String, Vec<energy::MissingPower>)],
    ) -> Self {
        let fitted = &diagnosis.given().fit;
        let instruments = fitted.instruments.iter().map(|one| Instrument {
            name: one.name.clone(),
            noise: finite(one.noise),
            unit: one.unit.to_string(),
        });
        let ledgers = ledgers.iter().map(|(source, found)| RecordingLedger {
            source: source.clone(),
            found: found.iter().map(MissingPower::of).collect(),
        });
        Diagnosis {
            verdict: diagnosis.verdict.kind,
            reasons: diagnosis.verdict.reasons.clone(),
            validation_error: ErrorChange {
                before: diagnosis.given().error.and_then(finite),
                after: diagnosis.supported().error.and_then(finite),
            },
            candidates: Candidate::all(diagnosis),
            rejected: Candidate::rejected(diagnosis),
            effects: SelectedEffect::all(diagnosis),
            remains: Remains::of(diagnosis),
            nuisances: Nuisance::shown(given, &diagnosis.supported().fit.model),
            balances: diagnosis.remainders.clone(),
            shares: diagnosis.map.iter().map(ResidualShare::of).collect(),
            unexplained: diagnosis.unexplained.as_ref().map(Unexplained::of),
            construction: Construction::of(diagnosis),
            too_coarse: diagnosis.verdict.is_too_coarse(),
            log_error_ratio: diagnosis.verdict.standings.first().and_then(|given| finite(given.log_error_ratio)),
            refitted: Parameter::of(&fitted.model, &fitted.model.unknown_parameters()),
            instruments: instruments.collect(),
            first_guess: guess.map(Guess::of),
            missing_power: ledgers.collect(),
            lost_messages: diagnosis.lost_messages.clone(),
        }
    }
}

impl SelectedEffect {
    fn all(diagnosis: &diagnosis::Diagnosis) -> Vec<Self> {
        let model = &diagnosis.supported().fit.model;
        let selected = diagnosis.selected().into_iter();
        selected
            .map(|one| SelectedEffect {
                effect: one.name().to_string(),
                cylinder: one.place().to_string(),
                probability: diagnosis.presence_of(&one).and_then(finite),
                log_error_ratio_after: finite(one.standing.log_error_ratio),
                parameters: Parameter::of_effect(model, one.name(), one.addition.site),
            })
            .collect()
    }
}

impl Nuisance {
    /// Those that were estimated in `fitted`, a model that began as `given`.
    fn shown(given: &Model, fitted: &Model) -> Vec<Self> {
        nuisances_shown(given, fitted)
            .map(|effect| Nuisance {
                effect: effect.name().to_string(),
                cylinder: site_name(&fitted.machine, effect.site).to_string(),
                parameters: Parameter::of_effect(fitted, effect.name(), effect.site),
            })
            .collect()
    }
}

impl Remains {
    fn of(diagnosis: &diagnosis::Diagnosis) -> Option<Self> {
        let left = diagnosis.remainders.iter().find(|one| !one.is_noise)?;
        Some(Remains { balance: left.equation.clone(), share: finite(left.after / left.before) })
    }
}

impl ResidualShare {
    fn of(share: &diagnosis::Share) -> Self {
        ResidualShare {
            equation: share.equation.clone(),
            regime: share.regime.to_string(),
            share_of_residual: finite(share.share_of_residual),
            share_of_time: finite(share.share_of_time),
        }
    }
}

impl Construction {
    fn of(diagnosis: &diagnosis::Diagnosis) -> Option<Self> {
        let trial = &diagnosis.trials[diagnosis.verdict.structural_alternative()?];
        let structural = trial.additions.iter().find(|one| !one.physics.card().family.is_candidate())?;
        let (model, name) = (&trial.fit.model, &structural.physics.card().name);
        Some(Construction {
            effect: name.to_string(),
            cylinder: site_name(&model.machine, structural.site).to_string(),
            validation_error_after: trial.error.and_then(finite),
            parameters: Parameter::of_effect(model, name, structural.site),
        })
    }
}
