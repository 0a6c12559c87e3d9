//! All candidates run a short race on coarse data; the first few are fitted to the end.
//!
//! A full fit of every effect at every place would take minutes. Four steps on thinned recordings already tell how much
//! of the error an effect can take away: the evidence itself is always from full fits.

use std::sync::atomic::{AtomicUsize, Ordering};

use excavator_model::effects::{Effect, Site};
use excavator_model::recording::Recording;
use rayon::prelude::*;

use super::candidate::{CandidateError, try_starts};
use super::{Candidate, DiagnosisSettings, compare_losses};
use crate::fit::{Fit, FitError, FitSettings, evaluate, fit};

/// Candidates that were fitted, best on validation first, and those that could not be, with the reason.
pub(super) type Round = (Vec<Candidate>, Vec<(String, CandidateError)>);

/// What candidates are measured against and on.
pub(super) struct Race<'a> {
    /// The model without them, fitted to the identification recordings.
    pub base: &'a Fit,
    /// The same on the validation recordings.
    pub base_validation: &'a Fit,
    /// Recordings that are fitted.
    pub identification: &'a [&'a Recording],
    /// Recordings that evidence is taken from.
    pub validation: &'a [&'a Recording],
    /// Thresholds.
    pub settings: &'a DiagnosisSettings,
}

impl Race<'_> {
    /// Tries all additions, best on validation first.
    ///
    /// # Errors
    /// [`FitError`] when the model without additions cannot be evaluated on thinned data.
    pub fn run(
        &self,
        wanted: &[(&'static dyn Effect, Site)],
        progress: &(dyn Fn(&str, f64) + Sync),
    ) -> Result<Round, FitError> {
        let coarse = FitSettings {
            sample_rate: self.settings.race_sample_rate,
            maximum_steps: self.settings.race_steps,
            ..self.settings.fit
        };
        let base = evaluate(&self.base.model, self.identification, &coarse)?;
        let base_validation = evaluate(&self.base.model, self.validation, &coarse)?;
        let heats = Race { base: &base, base_validation: &base_validation, ..*self };
        let done = AtomicUsize::new(0);
        // Full fits take about a third of the time.
        let total = wanted.len() as f64 * 1.5;
        let advance = |name: &str| progress(name, (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / total);

        let results: Vec<(String, Result<Candidate, CandidateError>)> = wanted
            .par_iter()
            .map(|&(physics, site)| {
                let place = excavator_model::site_name(&self.base.model.machine, site).to_string();
                let name = format!("{}@{place}", physics.card().name);
                let patience = FitSettings { give_up_above: base.loss() - self.settings.least_gain / 4.0, ..coarse };
                // One step from each start shows which is worth the others.
                let first_step = FitSettings { maximum_steps: 1, ..patience };
                let candidate = try_starts(&base.model, physics, site, self.identification, &first_step)
                    .and_then(|trial| Ok(fit(&trial.model, self.identification, &patience)?))
                    .and_then(|fit| heats.judged(physics, site, place, fit, &coarse));
                advance(&name);
                (name, candidate)
            })
            .collect();
        let mut tried = Vec::new();
        let mut failed = Vec::new();
        for (name, result) in results {
            match result {
                Ok(candidate) => tried.push(candidate),
                Err(error) => failed.push((name, error)),
            }
        }
        tried.sort_by(|a, b| b.identification_gain.total_cmp(&a.identification_gain));
        let best = tried.first().map_or(0.0, |candidate| candidate.identification_gain);
        let finalist = |(position, candidate): (usize, &Candidate)| {
            candidate.identification_gain >= self.settings.least_gain / 4.0
                && (position < self.settings.finalists
                    || best - candidate.identification_gain < self.settings.finalist_margin)
        };
        let finalists = tried.iter().enumerate().filter(|&entry| finalist(entry)).count();
        let mut rejected = tried.split_off(finalists);
        for candidate in &mut rejected {
            candidate.accepted = false;
        }
        let full: Vec<Result<Candidate, CandidateError>> = tried
            .par_iter()
            .map(|candidate| {
                let fit = fit(&candidate.fit.model, self.identification, &self.settings.fit)?;
                advance(candidate.name());
                self.judged(candidate.physics, candidate.site, candidate.place.clone(), fit, &self.settings.fit)
            })
            .collect();
        let mut finished = Vec::new();
        for (result, heat) in full.into_iter().zip(tried) {
            match result {
                Ok(candidate) => finished.push(candidate),
                Err(error) => failed.push((format!("{}@{}", heat.name(), heat.place), error)),
            }
        }
        finished.sort_by(|a, b| b.evidence.gain.total_cmp(&a.evidence.gain));
        mark_ties(&mut finished, self.settings);
        finished.extend(rejected);
        Ok((finished, failed))
    }

    /// A fitted candidate with its evidence.
    fn judged(
        &self,
        physics: &'static dyn Effect,
        site: Site,
        place: String,
        fit: Fit,
        settings: &FitSettings,
    ) -> Result<Candidate, CandidateError> {
        let validation = evaluate(&fit.model, self.validation, settings)?;
        let evidence = compare_losses(self.base_validation, &validation);
        let identification_gain = compare_losses(self.base, &fit).gain;
        let accepted = evidence.gain >= self.settings.least_gain
            && evidence.significance >= self.settings.least_significance
            && identification_gain >= self.settings.least_gain / 2.0;
        Ok(Candidate {
            physics,
            site,
            place,
            fit,
            validation,
            evidence,
            identification_gain,
            accepted,
            tied_with_first: false,
        })
    }
}

fn mark_ties(candidates: &mut [Candidate], settings: &DiagnosisSettings) {
    let Some((first, others)) = candidates.split_first_mut() else { return };
    for other in others.iter_mut().filter(|candidate| candidate.accepted) {
        let lead = compare_losses(&other.validation, &first.validation);
        other.tied_with_first = lead.gain < settings.tie_gain || lead.significance < settings.tie_significance;
        first.tied_with_first |= other.tied_with_first;
    }
}
