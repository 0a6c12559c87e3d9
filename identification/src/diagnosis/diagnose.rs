//! Diagnoses a model from recordings and returns a verdict.

use excavator_model::Model;
use excavator_model::recording::Recording;
use rayon::prelude::*;

use super::confirmed::confirmed;
use super::remainder::remainders;
use super::residual_map::{follows, residual_map};
use super::residual_points::points;
use super::{Remainder, Share, Unexplained};
use crate::decision::{Kind, Policy, Scores, Verdict, decide};
use crate::fit::FitError;
use crate::regression::RegressionError;
use crate::search::{Addition, Effort, Pool, Trial, Unpromising, search};
use crate::validation::mean_error;

/// Result of a diagnosis.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// The rules of the verdict.
    pub policy: Policy,
    /// The verdict on the scores.
    pub verdict: Verdict,
    /// The scores behind the verdict.
    pub scores: Scores,
    /// The fits behind the scores, one for each hypothesis.
    pub trials: Vec<Trial>,
    /// Additions to the given model whose fit was not completed, with the improvement that its first steps brought or promised,
    /// best first.
    pub unpromising: Vec<Unpromising>,
    /// Additions that could not be fitted, with the reason.
    pub failed: Vec<(String, String)>,
    /// Where the residual of the given model is, on the validation recordings.
    pub map: Vec<Share>,
    /// What is left in each balance on the validation recordings, the largest first.
    pub remainders: Vec<Remainder>,
    /// The remaining residual, if no effect explains it.
    pub unexplained: Option<Unexplained>,
    /// Messages that the recordings rest on and that were lost, one line each; whoever reads the recordings fills it in.
    pub lost_messages: Vec<String>,
}

/// Why a diagnosis fails.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnosisError {
    /// The residual cannot be formed.
    #[error(transparent)]
    Regression(#[from] RegressionError),
    /// The given model cannot be fitted.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// No validation recording.
    #[error("no validation recording; evidence must come from data that was not fitted")]
    NoValidation,
}

/// Settings of a diagnosis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DiagnosisSettings {
    /// How much is tried.
    pub effort: Effort,
    /// Rules of the verdict.
    pub policy: Policy,
}

/// Finds the effect that `model` is missing. Parameters are fitted to `identification`; evidence comes from `validation`.
/// `progress` receives the current step as text and the fraction done.
///
/// ```no_run
/// use excavator_identification::prelude::*;
/// use excavator_model::prelude::*;
///
/// # fn verdict(model: &Model, fitted: &Recording, judging: &Recording) -> Result<(), Box<dyn std::error::Error>> {
/// let progress = |what: &str, share: f64| eprintln!("{:3.0} % {what}", 100.0 * share);
/// let found = diagnose(model, &[fitted], &[judging], &DiagnosisSettings::default(), &progress)?;
/// if found.verdict.kind == Kind::MissingEffect {
///     for candidate in found.selected() {
///         println!("{} at {}", candidate.name(), candidate.place());
///     }
/// }
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`DiagnosisError`].
pub fn diagnose(
    model: &Model,
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &DiagnosisSettings,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<Diagnosis, DiagnosisError> {
    if validation.is_empty() {
        return Err(DiagnosisError::NoValidation);
    }
    let DiagnosisSettings { effort, policy } = settings;
    let pool = search(model, identification, validation, effort, policy, progress)?;
    let verdict = confirmed(&pool, decide(&pool.scores, policy), settings);
    progress("where the model fails", 1.0);
    Ok(diagnosis_of(pool, verdict, settings, validation)?)
}

/// Combines a search and its verdict into a diagnosis. The models that a refinement would write lose the nuisance effects that do
/// not show, so that both have the same parameters and errors.
///
/// # Errors
/// [`RegressionError`] if the recordings lack inputs.
pub(crate) fn diagnosis_of(
    pool: Pool<'_>,
    verdict: Verdict,
    settings: &DiagnosisSettings,
    validation: &[&Recording],
) -> Result<Diagnosis, RegressionError> {
    let (policy, identification, data_sheet) = (settings.policy, pool.identification(), pool.data_sheet().clone());
    let failed = pool.failed.into_iter().map(|(name, error)| (name, error.to_string())).collect();
    let (trials, scores, unpromising) = (pool.trials, pool.scores, pool.unpromising);
    let (map, remainders, unexplained) = (Vec::new(), Vec::new(), None);
    let lost_messages = Vec::new();
    let mut diagnosis =
        Diagnosis { policy, verdict, scores, trials, unpromising, failed, map, remainders, unexplained, lost_messages };
    let simple: Vec<(usize, Trial)> = diagnosis
        .on_paths()
        .into_par_iter()
        .map(|number| {
            let simple =
                diagnosis.trials[number].simplified(&data_sheet, identification, validation, &settings.effort.fit);
            // A model that cannot be fitted without them keeps them.
            Some((number, simple.ok()?))
        })
        .flatten()
        .collect();
    simple.into_iter().for_each(|(number, trial)| diagnosis.trials[number] = trial);
    let simulated: Vec<(usize, Option<f64>)> = diagnosis
        .shown()
        .into_par_iter()
        .map(|number| (number, mean_error(&diagnosis.trials[number].fit.model, validation).ok()))
        .collect();
    simulated.into_iter().for_each(|(number, error)| diagnosis.trials[number].error = error);
    diagnosis.locate(validation)?;
    Ok(diagnosis)
}

impl Diagnosis {
    /// Finds where the given model fails, and what the supported one leaves.
    fn locate(&mut self, validation: &[&Recording]) -> Result<(), RegressionError> {
        let number = self.verdict.supported();
        let (given, supported) = (&self.trials[0].fit.model, &self.trials[number].fit.model);
        let before = points(given, validation)?;
        let of_other = if number == 0 { None } else { Some(points(supported, validation)?) };
        let after = of_other.as_ref().unwrap_or(&before);
        // Slow recordings do not resolve a second derivative, so the force balance may seem to leave more than simulations do.
        let explains = self.verdict.standings[number].log_error_ratio <= self.policy.noise_margin;
        let map = residual_map(given, &before);
        let most = if explains { f64::INFINITY } else { self.policy.noise_in_balance };
        let remainders = remainders(given, &before, after, most);
        let unexplained = match self.verdict.kind {
            Kind::Unexplained => follows(supported, after, &self.policy).map(|left| {
                let ratios = [0, self.verdict.best].map(|number| self.verdict.standings[number].log_error_ratio);
                let differs_in_form = differs_in_form(&left, &self.supported().additions, ratios, &self.policy);
                Unexplained { differs_in_form, ..left }
            }),
            Kind::Adequate | Kind::MissingEffect => None,
        };
        (self.map, self.remainders, self.unexplained) = (map, remainders, unexplained);
        Ok(())
    }
}

/// Whether one effect is most of what is missing, and what it leaves looks like another form of it: it is in a balance of its own kind
/// and follows one variable. Otherwise something else is missing beside it. `before` and `after` are log error ratios.
fn differs_in_form(left: &Unexplained, found: &[Addition], [before, after]: [f64; 2], policy: &Policy) -> bool {
    let [only] = found else { return false };
    let is_of_forces = left.equation.ends_with(".motion");
    1.0 - after.max(0.0) / before >= policy.most_of_misfit
        && left.share_of_residual >= policy.share_of_a_law
        && only.physics.card().is_of_flows() != is_of_forces
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::effects::{Catalogue, Site};

    use super::*;

    #[test]
    fn another_form_is_in_its_own_balance_and_follows_one_variable() {
        let physics = Catalogue::built_in().find("valve_dead_zone").unwrap();
        let found = [Addition { physics, site: Site::Cylinder(0) }];
        let is_another_form = |equation: &str, share_of_residual: f64, after: f64| {
            let left = Unexplained {
                equation: equation.into(),
                variable: "command".into(),
                share_of_residual,
                follows_variable: true,
                differs_in_form: false,
                curve: Vec::new(),
                unit: "m3/s".into(),
            };
            differs_in_form(&left, &found, [2.0, after], &Policy::default())
        };
        assert!(is_another_form("arm.cap_continuity", 0.6, 0.4));
        assert!(!is_another_form("arm.motion", 0.6, 0.4), "a valve is no force");
        assert!(!is_another_form("arm.cap_continuity", 0.2, 0.4), "that is no law");
        assert!(!is_another_form("arm.cap_continuity", 0.6, 1.0), "half is not most");
    }
}
