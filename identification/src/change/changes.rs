//! Fits the same model to two sets of recordings and compares the parameters.

use excavator_model::Model;
use excavator_model::recording::Recording;

use crate::decision::Policy;
use crate::fit::{Fit, FitError, FitSettings, fit, is_nuisance, with_nuisances};
use crate::search::fit_given;

/// The same model, fitted to recordings before and to recordings after.
#[derive(Debug, Clone)]
pub struct Changes {
    /// Fitted to the recordings before.
    pub before: Fit,
    /// Fitted to the recordings after.
    pub after: Fit,
    /// The parameters of the machine that were fitted; those that changed first, the most significant first.
    pub parameters: Vec<ParameterChange>,
}

/// A parameter before and after.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterChange {
    /// Its number in the model.
    pub index: usize,
    /// Its name, `arm.coulomb_friction`.
    pub name: String,
    /// What it means.
    pub meaning: String,
    /// SI unit.
    pub unit: String,
    /// Value before and after, in `unit`.
    pub values: [f64; 2],
    /// Half of the 95 % interval of each value, in `unit`; infinite where the recordings do not determine it.
    pub margins_95: [f64; 2],
    /// Whether the recordings were of both sides and determine both values to better than themselves.
    pub is_determined: bool,
    /// Whether it changed by more than its uncertainty, and by enough to matter.
    pub has_changed: bool,
}

impl ParameterChange {
    /// Difference, after less before, in `unit`.
    pub fn difference(&self) -> f64 {
        self.values[1] - self.values[0]
    }

    /// Half of the 95 % interval of the difference, in `unit`.
    pub fn margin_95(&self) -> f64 {
        self.margins_95[0].hypot(self.margins_95[1])
    }

    /// Difference in standard errors.
    pub fn significance(&self) -> f64 {
        1.96 * self.difference().abs() / self.margin_95()
    }

    fn of(models: [&Model; 2], index: usize, name: String) -> Option<Self> {
        let [before, after] = models.map(|model| model.parameters().nth(index).map(|(_, parameter)| parameter));
        let (before, after) = (before?, after?);
        let values = [before.value, after.value];
        let margins_95 =
            [before, after].map(|one| one.margin_95.filter(|margin| margin.is_finite()).unwrap_or(f64::INFINITY));
        let mut change = ParameterChange {
            index,
            name,
            meaning: before.card.meaning.to_string(),
            unit: before.card.unit.to_string(),
            values,
            margins_95,
            is_determined: false,
            has_changed: false,
        };
        let policy = Policy::default();
        let size = values[0].abs().max(values[1].abs());
        change.is_determined = change.margin_95() < size;
        change.has_changed = change.is_determined
            && change.significance() >= policy.least_significance_of_change
            && change.difference().abs() >= policy.least_change * size;
        Some(change)
    }
}

/// Fits `model` to the recordings `before`, and from there to those `after`, and compares its parameters. Errors of instruments and
/// roundings are fitted in both and not compared: they belong to a recording, not to the machine.
///
/// # Errors
/// [`FitError`] if one of the fits fails.
pub fn changes(
    model: &Model,
    before: &[&Recording],
    after: &[&Recording],
    settings: &FitSettings,
) -> Result<Changes, FitError> {
    let all: Vec<&Recording> = before.iter().chain(after).copied().collect();
    let model = with_nuisances(model, &all);
    // Both fits start from one that saw everything, so that they do not end in different minima.
    let common = fit_given(&model, &all, settings)?;
    between(&common, before, after, settings)
}

/// Fits of two sets of recordings that start from the fit of both together.
pub(crate) fn between(
    common: &Fit,
    before: &[&Recording],
    after: &[&Recording],
    settings: &FitSettings,
) -> Result<Changes, FitError> {
    let (before, after) = rayon::join(|| fit(&common.model, before, settings), || fit(&common.model, after, settings));
    let (before, after) = (before?, after?);
    let names = common.model.parameter_names();
    let effects: Vec<usize> = common.model.parameters().map(|(effect, _)| effect).collect();
    let is_of_the_machine = |index: &&usize| !is_nuisance(common.model.effects[effects[**index]].physics.card().family);
    let compared = before.fitted.iter().filter(is_of_the_machine);
    let mut parameters: Vec<ParameterChange> = compared
        .filter_map(|&index| ParameterChange::of([&before.model, &after.model], index, names[index].clone()))
        .collect();
    parameters.sort_by(|a, b| {
        b.has_changed
            .cmp(&a.has_changed)
            .then(b.is_determined.cmp(&a.is_determined).then(b.significance().total_cmp(&a.significance())))
    });
    Ok(Changes { before, after, parameters })
}

impl Changes {
    /// Whether the model leaves more than noise before and after, with the parameters of that side.
    pub fn leaves_more_than_noise(&self) -> [bool; 2] {
        [&self.before, &self.after].map(|fit| fit.loss() > Policy::default().noise_margin)
    }

    /// The parameters that changed, the most significant first.
    pub fn changed(&self) -> impl Iterator<Item = &ParameterChange> {
        self.parameters.iter().filter(|parameter| parameter.has_changed)
    }

    /// The parameters that both sides determine and that did not change.
    pub fn unchanged(&self) -> impl Iterator<Item = &ParameterChange> {
        self.parameters.iter().filter(|parameter| parameter.is_determined && !parameter.has_changed)
    }

    /// The parameters that one side or both do not determine.
    pub fn undetermined(&self) -> impl Iterator<Item = &ParameterChange> {
        self.parameters.iter().filter(|parameter| !parameter.is_determined)
    }
}
