//! Refines a model until it is no longer missing an effect.

use excavator_model::recording::Recording;
use excavator_model::simulation::RunError;
use excavator_model::{HistoryEntry, Model, ModelError, addition_name, site_name};

use crate::decision::Kind;
use crate::diagnosis::{Diagnosis, DiagnosisError, DiagnosisSettings, NamedVerdict, diagnose, judge_named};
use crate::fit::{Fit, FitError, nuisances_shown, simplified};
use crate::proposal::propose;
use crate::search::{Addition, AdditionError, fit_addition, fit_given};
use crate::validation::{Comparison, compare, mean_error_of};

/// Effects to add.
#[derive(Debug, Clone)]
pub enum Additions {
    /// The effects that the diagnosis finds, one after the other.
    Auto,
    /// The same; if no effect of the catalogue explains the recordings, also a proposed law.
    AutoWithLaws,
    /// These effects, one after the other.
    Named(Vec<Addition>),
}

impl Additions {
    /// The effects that a user names: each `EFFECT` at every place where it can act, `EFFECT@PLACE` at one.
    ///
    /// ```
    /// use excavator_identification::prelude::*;
    /// use excavator_model::prelude::*;
    ///
    /// let model = built_in("zx30u-arm")?;
    /// let additions = Additions::named(&model, &["valve_dead_zone@arm".to_string()])?;
    /// assert!(matches!(additions, Additions::Named(named) if named[0].name(&model) == "valve_dead_zone@arm"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RefineError::Model`], [`RefineError::Twice`].
    pub fn named(model: &Model, names: &[String]) -> Result<Self, RefineError> {
        let mut additions = Vec::new();
        for name in names {
            for (physics, site) in model.parse_addition(name)? {
                let addition = Addition { physics, site };
                if additions.contains(&addition) {
                    return Err(RefineError::Twice(name.clone()));
                }
                additions.push(addition);
            }
        }
        Ok(Additions::Named(additions))
    }
}

/// The model after one addition.
#[derive(Debug, Clone)]
pub struct Step {
    /// The added effect, `effect@place`; `None` for the given model, refitted.
    pub added: Option<String>,
    /// The model, fitted to the identification recordings.
    pub fit: Fit,
    /// Its comparison with each validation recording.
    pub comparisons: Vec<Comparison>,
}

impl Step {
    /// Mean normalised squared error over signals and validation recordings.
    pub fn mean_error(&self) -> f64 {
        mean_error_of(&self.comparisons)
    }
}

/// A refined model and its steps.
#[derive(Debug, Clone)]
pub struct Refinement {
    /// The given model.
    pub given_model: Model,
    /// Comparisons of the given model, with its own parameters, on the validation recordings; empty if it cannot be simulated.
    pub given: Vec<Comparison>,
    /// The steps; step 0 is the given model, refitted.
    pub steps: Vec<Step>,
    /// The final model, its history extended.
    pub model: Model,
    /// Why these effects were added.
    pub reason: Reason,
}

/// Why effects were added.
#[derive(Debug, Clone)]
pub enum Reason {
    /// A diagnosis found them.
    Found(Box<Diagnosis>),
    /// A user named them; the verdict on them.
    Named(NamedVerdict),
}

impl Refinement {
    /// The verdict on the given model; for named additions, whether they explain what it was missing.
    pub fn verdict(&self) -> Kind {
        match &self.reason {
            Reason::Found(diagnosis) => diagnosis.verdict.kind,
            Reason::Named(named) => named.kind,
        }
    }

    /// What each step added, with its comparisons.
    pub fn compared_steps(&self) -> impl Iterator<Item = (Option<&str>, &[Comparison])> {
        self.steps.iter().map(|step| (step.added.as_deref(), step.comparisons.as_slice()))
    }

    /// The diagnosis behind automatic additions.
    pub fn diagnosis(&self) -> Option<&Diagnosis> {
        match &self.reason {
            Reason::Found(diagnosis) => Some(diagnosis),
            Reason::Named(_) => None,
        }
    }
}

/// Why a refinement fails.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RefineError {
    /// The diagnosis failed.
    #[error(transparent)]
    Diagnosis(#[from] DiagnosisError),
    /// An effect does not fit the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A fit failed.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A simulation failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// An effect is named twice at the same place.
    #[error("cannot add {0} twice")]
    Twice(String),
    /// The fit with an effect has a larger loss than the one without it, so the search failed and its result shows nothing about
    /// the effect.
    #[error(
        "{added} was not added: no fit with it comes as near to the identification recordings as the model without it (loss {after:.3}, without {before:.3}). Give the effect better start values in the model file, or recordings that show it"
    )]
    NoBetterFit {
        /// What was to be added, `effect@place`.
        added: String,
        /// Loss of the model without it ([`Fit::loss`]).
        before: f64,
        /// The same with it.
        after: f64,
    },
}

impl From<AdditionError> for RefineError {
    fn from(error: AdditionError) -> Self {
        match error {
            AdditionError::Model(error) => RefineError::Model(error),
            AdditionError::Fit(error) => RefineError::Fit(error),
        }
    }
}

/// Refines `model`. `when` (ISO 8601) is written to the model's history; `progress` receives the current step and the fraction
/// done.
///
/// ```no_run
/// use excavator_identification::prelude::*;
/// use excavator_model::prelude::*;
///
/// # fn better(model: &Model, fitted: &Recording, judging: &Recording) -> Result<(), Box<dyn std::error::Error>> {
/// let settings = DiagnosisSettings::default();
/// let when = "2025-01-01T00:00:00Z";
/// let refined = refine(model, &[fitted], &[judging], &Additions::Auto, &settings, when, &|_, _| {})?;
/// for step in &refined.steps {
///     println!("{}: error {:.2e}", step.added.as_deref().unwrap_or("refitted"), step.mean_error());
/// }
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`RefineError`].
pub fn refine(
    model: &Model,
    identification: &[&Recording],
    validation: &[&Recording],
    additions: &Additions,
    settings: &DiagnosisSettings,
    when: &str,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<Refinement, RefineError> {
    if validation.is_empty() {
        return Err(DiagnosisError::NoValidation.into());
    }
    let (fits, reason) = match additions {
        Additions::Auto => found(model, diagnose(model, identification, validation, settings, progress)?),
        Additions::AutoWithLaws => {
            found(model, propose(model, identification, validation, settings, progress)?.diagnosis)
        }
        Additions::Named(named) => as_named(model, named, identification, validation, settings, progress)?,
    };
    let fitted_to: Vec<String> = identification.iter().map(|recording| recording.source.clone()).collect();
    with_fits(model, fits, reason, &fitted_to, validation, when)
}

/// The refinement that follows from a diagnosis of `model`, without another search. `fitted_to` names the identification recordings.
///
/// # Errors
/// [`RefineError`].
pub fn refinement_of(
    model: &Model,
    diagnosis: Diagnosis,
    fitted_to: &[String],
    validation: &[&Recording],
    when: &str,
) -> Result<Refinement, RefineError> {
    let (fits, reason) = found(model, diagnosis);
    with_fits(model, fits, reason, fitted_to, validation, when)
}

fn with_fits(
    model: &Model,
    fits: Fits,
    reason: Reason,
    fitted_to: &[String],
    validation: &[&Recording],
    when: &str,
) -> Result<Refinement, RefineError> {
    let given =
        validation.iter().map(|recording| compare(model, recording)).collect::<Result<_, _>>().unwrap_or_default();
    let mut steps: Vec<Step> = Vec::new();
    for (added, fit) in fits {
        let comparisons =
            validation.iter().map(|recording| compare(&fit.model, recording)).collect::<Result<Vec<_>, _>>()?;
        steps.push(Step { added, fit, comparisons });
    }
    let mut final_model = steps.last().map_or_else(|| model.clone(), |step| step.fit.model.clone());
    final_model.history.clone_from(&model.history);
    let recordings: Vec<String> =
        fitted_to.iter().cloned().chain(validation.iter().map(|recording| recording.source.clone())).collect();
    for (number, step) in steps.iter().enumerate() {
        let before = number.checked_sub(1).map(|previous| steps[previous].mean_error());
        final_model.history.push(HistoryEntry {
            when: when.to_string(),
            what: what_was_done(number.checked_sub(1).map_or(model, |previous| &steps[previous].fit.model), step),
            recordings: recordings.clone(),
            validation_error_before: before,
            validation_error_after: Some(step.mean_error()),
        });
    }
    for parameter in final_model.parameters_mut().filter(|parameter| !parameter.known) {
        parameter.source = "identified".into();
    }
    Ok(Refinement { given_model: model.clone(), given, steps, model: final_model, reason })
}

/// Fits of a model, each with the name of the last addition.
type Fits = Vec<(Option<String>, Fit)>;

/// The fits on the path of a diagnosis from the given model to the supported hypothesis.
fn found(model: &Model, diagnosis: Diagnosis) -> (Fits, Reason) {
    let mut fits = vec![(None, diagnosis.given().fit.clone())];
    let selected = diagnosis.selected();
    for (number, candidate) in selected.iter().enumerate() {
        // If several effects were added together, only the last has a model of its own.
        let next = selected.get(number + 1);
        if next.is_none_or(|next| !std::ptr::eq(next.trial, candidate.trial)) {
            fits.push((Some(candidate.addition.name(model)), candidate.trial.fit.clone()));
        }
    }
    (fits, Reason::Found(Box::new(diagnosis)))
}

/// Adds named effects, one after the other.
fn as_named(
    model: &Model,
    named: &[Addition],
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &DiagnosisSettings,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<(Fits, Reason), RefineError> {
    let fitting = &settings.effort.fit;
    progress("fit of the given model", 0.0);
    let given = fit_given(model, identification, fitting)?;
    let (mut added, mut current) = (Vec::new(), given.clone());
    let mut fits = vec![(None, given.clone())];
    for (number, addition) in named.iter().enumerate() {
        let name = addition.name(model);
        progress(&name, (number + 1) as f64 / (named.len() + 1) as f64);
        let before = current.loss();
        current = fit_addition(&current.model, addition, identification, fitting)?;
        if current.loss() > before + LARGEST_RISE {
            return Err(RefineError::NoBetterFit { added: name, before, after: current.loss() });
        }
        added.push((addition.clone(), current.clone()));
        fits.push((Some(name), current.clone()));
    }
    let verdict = judge_named(&given, &added, identification, validation, fitting, &settings.policy)?;
    for (_, fit) in &mut fits {
        *fit = simplified(model, fit, identification, fitting)?;
    }
    Ok((fits, Reason::Named(verdict)))
}

/// Difference in loss that is allowed between two fits of the same optimum: neither reaches it exactly.
const LARGEST_RISE: f64 = 0.01;

/// Text for a model's history: the step, and the nuisances that are significant since the model `before`.
fn what_was_done(before: &Model, step: &Step) -> String {
    let nuisances: Vec<String> = nuisances_shown(before, &step.fit.model)
        .map(|effect| addition_name(effect.name(), site_name(&before.machine, effect.site)))
        .collect();
    let done = step.added.as_ref().map_or_else(|| "parameters identified".to_string(), |name| format!("added {name}"));
    if nuisances.is_empty() { done } else { format!("{done}; nuisances: {}", nuisances.join(", ")) }
}
