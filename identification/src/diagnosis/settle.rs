//! Ties that more than one effect leaves, asked again once all of them are known.
//!
//! Where two effects are missing, the first of them was compared with others while the second still spoiled the picture: a
//! valve's leakage looks like its play while a sensor is off as well, and a pump that leaks beside a valve with a dead zone like a
//! relief valve. With everything else in the model most ties are none, and some leads are ties. What is fitted along with the first
//! counts as such a thing: friction that turns round over 2 mm/s was told as Stribeck friction beside a quadratic loss that is
//! really there, since whoever comes first takes up the corner as well.

use super::chain::{Chains, OTHER_WAY};
use super::own_windows::evaluate_in_known_windows;
use super::{Candidate, DiagnosisError};
use crate::fitted_along::found_along;

impl Chains<'_> {
    /// Compares the first of `candidates` with all that are tied with it, or gained half as much (`rejected` or not), beside the
    /// other links of `chain` and what was fitted along with them: marks those that are tied there, and begins the chain with the
    /// best of them. `candidates` begin with the chain's first link, before and after; whoever of the rejected is named joins them.
    ///
    /// # Errors
    /// [`DiagnosisError`] when a model cannot be evaluated.
    pub fn settle_ties(
        &self,
        chain: Vec<Candidate>,
        candidates: &mut Vec<Candidate>,
        rejected: &mut Vec<Candidate>,
        progress: &(dyn Fn(&str, f64) + Sync),
    ) -> Result<Vec<Candidate>, DiagnosisError> {
        let (Some((first, others)), Some(last)) = (chain.split_first(), chain.last()) else { return Ok(chain) };
        let is_other = |candidate: &Candidate| others.iter().any(|link| link.is_same_addition(candidate));
        let least = OTHER_WAY * candidates.first().map_or(0.0, |first| first.evidence.gain);
        let rivals: Vec<_> = candidates
            .iter()
            .chain(rejected.iter())
            .filter(|candidate| candidate.tied_with_first || candidate.evidence.gain >= least)
            .filter(|candidate| !is_other(candidate))
            .map(|candidate| (candidate.physics, candidate.site))
            .collect();
        let is_alone = others.is_empty() && found_along(&self.nominal.model, &last.fit.model).next().is_none();
        if is_alone || rivals.len() < 2 {
            return Ok(chain);
        }
        let Ok(base) = self.without_link(last, first) else { return Ok(chain) };
        let known = &last.validation.model;
        let base_validation = evaluate_in_known_windows(&base.model, known, self.validation, &self.settings.fit)?;
        let race = self.race_from(&base, &base_validation, self.is_adequate(&base_validation));
        let round = race.run(&rivals, &|what, _| progress(what, 0.95));
        let Some(best) = round.fitted.first().filter(|best| best.accepted) else { return Ok(chain) };
        let named = |candidate: &Candidate| {
            round
                .fitted
                .iter()
                .filter(|rival| rival.is_same_addition(best) || rival.tied_with_first)
                .find(|rival| rival.is_same_addition(candidate))
        };
        let joining = rejected.extract_if(.., |candidate| named(candidate).is_some());
        candidates.extend(joining.map(|candidate| Candidate {
            accepted: true,
            evidence: named(&candidate).map_or(candidate.evidence, |rival| rival.evidence),
            ..candidate
        }));
        let chain = if best.is_same_addition(first) {
            chain
        } else {
            // What comes after it is looked for anew: what was second beside another need not be second beside this one.
            let alone = candidates.iter().find(|candidate| candidate.is_same_addition(best)).cloned();
            let Some(alone) = alone else { return Ok(chain) };
            // Whatever becomes of it, the first does not stand alone.
            for candidate in candidates.iter_mut() {
                candidate.tied_with_first |= candidate.is_same_addition(best) || candidate.is_same_addition(first);
            }
            let grown = self.grow(alone, progress)?;
            let is_better = grown.last().is_some_and(|other| other.validation.loss() < last.validation.loss());
            if !is_better || !self.explains(&grown) || grown.first().is_none_or(|link| !link.is_same_addition(best)) {
                return Ok(chain);
            }
            grown
        };
        let still_tied = |candidate: &Candidate| {
            round.fitted.iter().any(|rival| rival.tied_with_first && rival.is_same_addition(candidate))
        };
        for candidate in candidates.iter_mut() {
            candidate.tied_with_first = still_tied(candidate);
        }
        if let Some(place) = candidates.iter().position(|candidate| candidate.is_same_addition(best)) {
            candidates[..=place].rotate_right(1);
        }
        Ok(chain)
    }
}
