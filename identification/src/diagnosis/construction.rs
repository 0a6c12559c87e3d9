//! How a machine may be built, against what the candidates say.
//!
//! Whether a joint has a spring or a valve a compensator anybody can see, so no diagnosis names them. But what such an effect
//! explains better than a candidate does not get that candidate's name, and neither does what it explains as well.

use excavator_model::Model;
use excavator_model::effects::{Effect, Family, Site};

use super::candidate::{CandidateError, best_start, free_effects};
use super::chain::Chains;
use super::evidence::joint_significance;
use super::own_windows::evaluate_in_known_windows;
use super::{Candidate, compare_losses};
use crate::fit::fit_predicted;

/// Loss above that of a model with a candidate, from which on an effect of construction is not worth a fit in its place; or half of
/// what the candidate explains, where that is more: a first step does not promise all.
const FAR: f64 = 0.5;

/// How a model that is built otherwise compares with a chain of candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Standing {
    /// Better beyond doubt, on both kinds of recordings.
    Ahead,
    /// Nobody can tell.
    Level,
    /// Worse beyond doubt.
    Behind,
}

/// Effects of construction beside a chain.
#[derive(Debug, Default)]
pub(super) struct BuiltOtherwise {
    /// In place of a link they explain more.
    pub ahead: Vec<Candidate>,
    /// In place of the first link they explain as much.
    pub level: Vec<Candidate>,
}

impl Chains<'_> {
    /// Effects of construction that explain more in place of a link of `chain`, at its site, or as much in that of the first.
    pub fn built_otherwise(&self, chain: &[Candidate]) -> BuiltOtherwise {
        let mut found = BuiltOtherwise::default();
        let Some(last) = chain.last() else { return found };
        for (number, link) in chain.iter().enumerate() {
            let Ok(without) = self.without_link(last, link) else { continue };
            let worst = last.fit.loss() + FAR.max(0.5 * (without.loss() - last.fit.loss()));
            let model = &without.model;
            for (physics, site) in constructions(model).into_iter().filter(|(_, site)| *site == link.site) {
                let Ok(Some(other)) = self.with_construction(model, physics, site, worst, &last.validation.model)
                else {
                    continue;
                };
                match self.standing(&other, last) {
                    Standing::Ahead => found.ahead.push(other),
                    // Ties are told of the first of a chain.
                    Standing::Level if number == 0 => found.level.push(other),
                    Standing::Level | Standing::Behind => {}
                }
            }
        }
        found
    }

    /// The effect of construction that explains the recordings where no candidate does.
    pub fn built_as_nothing_named(&self) -> Option<Candidate> {
        let (model, settings) = (&self.nominal.model, self.settings);
        let least = settings.least_explained_share;
        let explains = |other: &Candidate| {
            other.evidence.gain >= least * self.nominal_validation.loss()
                && other.identification_gain >= least * self.nominal.loss()
                && other.evidence.significance >= settings.least_significance
        };
        constructions(model)
            .into_iter()
            .filter_map(|(physics, site)| {
                let worst = (1.0 - least) * self.nominal.loss() + FAR;
                self.with_construction(model, physics, site, worst, &self.nominal_validation.model).ok()?
            })
            .filter(explains)
            .max_by(|a, b| a.evidence.gain.total_cmp(&b.evidence.gain))
    }

    /// `model` with an effect of construction, fitted; nothing where its first step promises a loss above `worst`. Windows of time
    /// on the validation recordings are those of `known`.
    fn with_construction(
        &self,
        model: &Model,
        physics: &'static dyn Effect,
        site: Site,
        worst: f64,
        known: &Model,
    ) -> Result<Option<Candidate>, CandidateError> {
        let settings = &self.settings.fit;
        let start = best_start(model, physics, site, self.identification, settings)?;
        if start.promise.loss_after > worst {
            return Ok(None);
        }
        let fit = fit_predicted(&start.model, start.promise, self.identification, settings)?;
        let validation = evaluate_in_known_windows(&fit.model, known, self.validation, settings)?;
        let candidate = Candidate::new(physics, site, [fit, validation], [self.nominal, self.nominal_validation]);
        Ok(Some(candidate))
    }

    fn standing(&self, other: &Candidate, last: &Candidate) -> Standing {
        let fitted = compare_losses(&last.fit, &other.fit);
        let validated = compare_losses(&last.validation, &other.validation);
        let significance = joint_significance(fitted, validated);
        let doubt = self.settings.tie_significance;
        if fitted.gain > 0.0 && validated.gain > 0.0 && significance >= doubt {
            Standing::Ahead
        } else if significance > -doubt {
            Standing::Level
        } else {
            Standing::Behind
        }
    }
}

/// Every effect of construction at every place where it can act and is not yet.
fn constructions(model: &Model) -> Vec<(&'static dyn Effect, Site)> {
    free_effects(model, |family| family == Family::Construction)
}
