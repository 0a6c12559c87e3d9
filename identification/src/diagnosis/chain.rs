//! Effects added one after the other.
//!
//! The effect that lowers the error most need not be one that is missing: where two are, something in between may look
//! better than either. So links that are no longer needed once others are there are taken out again, and when the first
//! way leads nowhere, the runner-up is tried as a first step too.

use excavator_model::Model;
use excavator_model::effects::{ActsOn, Effect, Site};
use excavator_model::recording::Recording;

use super::adequacy::inputs_explain_the_rest;
use super::candidate::addition_with_effects_along;
use super::own_windows::{evaluate_in_known_windows, has_window};
use super::race::{Race, Round};
use super::starts::acts_in_a_window;
use super::{Candidate, DiagnosisError, DiagnosisSettings, additions, adequacy, compare_losses};
use crate::fit::{Fit, FitError, fit};

/// A gain below this part of the best one's is no other way to begin.
pub(super) const OTHER_WAY: f64 = 0.5;

/// What an effect at one of several places must gain, as a part of the best candidate's gain, to be tried at all of them. Late
/// sensors at one place take half to two thirds of what a lag of the valve takes, where all sensors are late.
const EVERYWHERE: f64 = 0.25;

/// What chains grow from and are judged on.
pub(super) struct Chains<'a> {
    /// The model without additions, fitted.
    pub nominal: &'a Fit,
    /// The same on the validation recordings.
    pub nominal_validation: &'a Fit,
    /// Whether that is adequate as it is.
    pub nominal_is_adequate: bool,
    /// Recordings that are fitted.
    pub identification: &'a [&'a Recording],
    /// Recordings that evidence is taken from.
    pub validation: &'a [&'a Recording],
    /// Thresholds.
    pub settings: &'a DiagnosisSettings,
}

impl Chains<'_> {
    /// The best chain that begins with a candidate of `round`, the additions to the nominal model; and these.
    ///
    /// # Errors
    /// [`DiagnosisError`] when a model cannot be evaluated.
    pub fn best(
        &self,
        round: Round,
        progress: &(dyn Fn(&str, f64) + Sync),
    ) -> Result<(Vec<Candidate>, Round), DiagnosisError> {
        let accepted: Vec<&Candidate> = round.fitted.iter().filter(|candidate| candidate.accepted).collect();
        let Some((&first, others)) = accepted.split_first() else { return Ok((Vec::new(), round)) };
        let chain = self.grow(first.clone(), progress)?;
        let least = OTHER_WAY * first.evidence.gain;
        let other = others.iter().find(|other| other.evidence.gain >= least && !self.contains(&chain, other));
        let chain = match other {
            Some(&other) if !self.explains(&chain) => {
                let second = self.grow(other.clone(), progress)?;
                if self.explains(&second) { second } else { chain }
            }
            _ => chain,
        };
        let everywhere = self.everywhere(&accepted, &chain, progress)?;
        let (Some(last), Some(reached)) = (chain.last(), everywhere.last()) else { return Ok((chain, round)) };
        let lead = compare_losses(&last.validation, &reached.validation);
        let settings = self.settings;
        if lead.gain >= settings.tie_gain && lead.significance >= settings.tie_significance {
            return Ok((everywhere, round));
        }
        let behind = compare_losses(&reached.validation, &last.validation);
        let is_behind = behind.gain >= settings.tie_gain && behind.significance >= settings.tie_significance;
        if chain.len() == 1 && !is_behind && self.explains(&everywhere) {
            // All sensors late is as good as a valve that is: nobody can tell from outside.
            let alike = [&chain[0], &everywhere[0]].map(|link| (link.name(), link.site));
            let round = Round { fitted: with_ties(round.fitted, &alike), ..round };
            return Ok((chain, round));
        }
        Ok((chain, round))
    }

    /// One effect at several places (late pressures at a cylinder and at the pump) is one cause, but a chain that begins
    /// with the best single place may begin with something else that reaches all of them. The chain of such an effect,
    /// where it has no more kinds of effects than `chain`; empty where there is none.
    fn everywhere(
        &self,
        accepted: &[&Candidate],
        chain: &[Candidate],
        progress: &(dyn Fn(&str, f64) + Sync),
    ) -> Result<Vec<Candidate>, DiagnosisError> {
        let least = EVERYWHERE * accepted.first().map_or(0.0, |first| first.evidence.gain);
        let is_shared = |one: &Candidate| {
            // A pump pressure that is late may gain nothing before late pressures at the cylinder are there.
            matches!(one.physics.card().acts_on, ActsOn::CylinderOrPumpLine | ActsOn::Instruments)
                || accepted.iter().any(|other| other.name() == one.name() && other.place != one.place)
        };
        let is_in_chain = |name: &str| chain.iter().any(|link| link.name() == name);
        let first =
            accepted.iter().find(|one| one.evidence.gain >= least && is_shared(one) && !is_in_chain(one.name()));
        let Some(first) = first else { return Ok(Vec::new()) };
        let wanted = |physics: &dyn Effect| physics.card().name == first.name() || is_in_chain(physics.card().name);
        let other = self.grow_among((*first).clone(), &wanted, progress)?;
        let places = other.iter().filter(|link| link.name() == first.name()).count();
        let kinds = other.len() + 1 - places;
        Ok(if places > 1 && kinds <= chain.len() { other } else { Vec::new() })
    }

    /// Whether a chain of effects explains the recordings: the model is adequate with them, or so much better and good
    /// enough, or what it leaves is no more than the readings of the inputs leave open. What leaves more than right effects do must
    /// take away the more, and several effects, which imitate more than one can, may leave the less.
    pub fn explains(&self, chain: &[Candidate]) -> bool {
        let settings = self.settings;
        let Some(last) = chain.last().map(|last| &last.validation) else {
            return self.nominal_is_adequate;
        };
        let share = (1.0 - last.loss() / self.nominal_validation.loss()).min(self.share_where_fitted(chain));
        let least = if chain.len() > 1 { settings.least_shared_share } else { settings.least_explained_share };
        let typical_share = 1.0 - last.typical_loss() / self.nominal_validation.typical_loss();
        let effects = chain.len() as f64;
        let is_right = last.typical_loss() <= settings.right_loss / effects
            || 1.0 - typical_share <= (1.0 - settings.resembling_share) / effects;
        if self.is_adequate(last) {
            return share >= least && is_right;
        }
        is_right && share >= least.max(settings.explained_share) && last.typical_loss() <= settings.explained_loss
            // What readings leave open is no reason to name something in a model that lacks nothing.
            || !self.nominal_is_adequate
                && inputs_explain_the_rest(last, self.nominal_validation, least, self.validation, settings)
    }

    /// What a chain takes away of the loss on the identification recordings, where it has windows of time: on the validation recordings
    /// these are fitted too, and what they take away there is no prediction.
    fn share_where_fitted(&self, chain: &[Candidate]) -> f64 {
        let Some(last) = chain.last().filter(|last| last.fit.model.effects.iter().any(has_window)) else {
            return f64::INFINITY;
        };
        1.0 - last.fit.loss() / self.nominal.loss()
    }

    fn contains(&self, chain: &[Candidate], other: &Candidate) -> bool {
        chain.iter().any(|link| link.is_same_addition(other))
    }

    /// The chain that begins with `first`, until nothing more is gained and every link is needed.
    ///
    /// # Errors
    /// [`DiagnosisError`] when a model cannot be evaluated.
    pub fn grow(
        &self,
        first: Candidate,
        progress: &(dyn Fn(&str, f64) + Sync),
    ) -> Result<Vec<Candidate>, DiagnosisError> {
        self.grow_among(first, &|_| true, progress)
    }

    /// [`Chains::grow`] of effects that are `wanted`.
    fn grow_among(
        &self,
        first: Candidate,
        wanted: &dyn Fn(&dyn Effect) -> bool,
        progress: &(dyn Fn(&str, f64) + Sync),
    ) -> Result<Vec<Candidate>, DiagnosisError> {
        let mut chain = vec![self.with_effects_along(first)?];
        // Each detour costs a link that is taken out again.
        for _ in 0..2 * self.settings.most_effects {
            let next = if chain.last().is_some_and(|last| self.leaves_little(last))
                || chain.len() > self.settings.most_effects
            {
                None
            } else {
                self.round(&chain, wanted, progress).fitted.into_iter().find(|candidate| candidate.accepted)
            };
            let complete = next.is_none();
            chain.extend(next.map(|next| self.with_effects_along(next)).transpose()?);
            match self.without_superfluous(&chain, progress)? {
                Some(shorter) => chain = shorter,
                None if complete => break,
                None => {}
            }
        }
        // One more than the most was for a detour; there was none.
        chain.truncate(self.settings.most_effects);
        Ok(chain)
    }

    /// A link with what the recordings show of how they were made once it is there: without it that was hidden under what
    /// was missing.
    fn with_effects_along(&self, mut link: Candidate) -> Result<Candidate, DiagnosisError> {
        let given = link.fit.model.effects.len();
        link.fit = addition_with_effects_along(link.fit, self.identification, &self.settings.fit);
        if link.fit.model.effects.len() > given {
            let known = &link.validation.model;
            link.validation = evaluate_in_known_windows(&link.fit.model, known, self.validation, &self.settings.fit)?;
        }
        Ok(link)
    }

    /// Whether a model is adequate, by its evaluation on the validation recordings.
    pub fn is_adequate(&self, evaluated: &Fit) -> bool {
        adequacy(evaluated, self.validation, self.settings).is_some()
    }

    /// Whether nothing that could be named is left: the model is adequate, and its whole loss less than another effect would
    /// have to take away.
    fn leaves_little(&self, last: &Candidate) -> bool {
        self.is_adequate(&last.validation) && last.validation.loss() < self.settings.least_gain_when_adequate
    }

    /// The model of a chain that ends with `last` without one of its links, fitted.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn without_link(&self, last: &Candidate, link: &Candidate) -> Result<Fit, FitError> {
        let mut without = last.fit.model.clone();
        without.effects.retain(|effect| !effect.is(link.name(), link.site));
        let names = |model: &Model| -> Vec<(&str, Site)> {
            model.effects.iter().map(|effect| (effect.name(), effect.site)).collect()
        };
        if names(&without) == names(&self.nominal.model) {
            return Ok(self.nominal.clone());
        }
        fit(&without, self.identification, &self.settings.fit)
    }

    /// The chain without the link whose removal costs least, if that is less than would have let it in.
    fn without_superfluous(
        &self,
        chain: &[Candidate],
        progress: &(dyn Fn(&str, f64) + Sync),
    ) -> Result<Option<Vec<Candidate>>, DiagnosisError> {
        let settings = self.settings;
        let Some((last, earlier)) = chain.split_last() else { return Ok(None) };
        let mut least: Option<(f64, usize)> = None;
        for (link, tried) in earlier.iter().enumerate() {
            let mut shorter = last.fit.model.clone();
            let place = shorter.effects.iter().position(|effect| effect.is(tried.name(), tried.site));
            let Some(place) = place else { continue };
            let removed = shorter.effects.remove(place);
            if acts_in_a_window(removed.physics, &shorter.machine, removed.site) {
                continue;
            }
            let Ok(shorter) = fit(&shorter, self.identification, &settings.fit) else { continue };
            let known = &last.validation.model;
            let without = evaluate_in_known_windows(&shorter.model, known, self.validation, &settings.fit)?;
            let worth = compare_losses(&without, &last.validation);
            let needed = worth.gain >= settings.least_gain && worth.significance >= settings.least_significance;
            if !needed && least.is_none_or(|(gain, _)| worth.gain < gain) {
                least = Some((worth.gain, link));
            }
        }
        let Some((_, superfluous)) = least else { return Ok(None) };
        // What came after it is begun with in the order that suits the chain without it: a link that only helps on top of
        // another, which came later, would not get past the start.
        let (kept, rest) = chain.split_at(superfluous);
        self.rebuilt(kept, rest.iter().skip(1).map(|link| (link.physics, link.site)).collect(), progress)
    }

    /// `kept` with the effects `wanted` in the order that suits; `None` when one of them cannot be fitted there.
    fn rebuilt(
        &self,
        kept: &[Candidate],
        mut wanted: Vec<(&'static dyn Effect, Site)>,
        progress: &(dyn Fn(&str, f64) + Sync),
    ) -> Result<Option<Vec<Candidate>>, DiagnosisError> {
        let mut rebuilt = kept.to_vec();
        while !wanted.is_empty() {
            let round = self.race(&rebuilt).run(&wanted, &|what, _| progress(what, 0.9));
            // Without the other it cannot even be begun with: then that was needed after all.
            let Some(next) = round.fitted.into_iter().next() else { return Ok(None) };
            wanted.retain(|&(physics, site)| (physics.card().name, site) != (next.name(), next.site));
            rebuilt.push(self.with_effects_along(next)?);
        }
        Ok(Some(rebuilt))
    }

    /// All additions to a chain of effects that are `wanted`.
    pub fn round(
        &self,
        chain: &[Candidate],
        wanted: &dyn Fn(&dyn Effect) -> bool,
        progress: &(dyn Fn(&str, f64) + Sync),
    ) -> Round {
        let race = self.race(chain);
        let start = 0.15 + 0.8 * chain.len() as f64 / (self.settings.most_effects + 1) as f64;
        let span = 0.8 / (self.settings.most_effects + 1) as f64;
        let mut additions = additions(&race.base.model);
        additions.retain(|(physics, _)| wanted(*physics));
        race.run(&additions, &|what, fraction| progress(what, start + span * fraction))
    }

    /// What competes for the next link.
    fn race<'c>(&'c self, chain: &'c [Candidate]) -> Race<'c> {
        match chain.last() {
            Some(last) => self.race_from(&last.fit, &last.validation, self.is_adequate(&last.validation)),
            None => self.race_from(self.nominal, self.nominal_validation, self.nominal_is_adequate),
        }
    }

    /// What competes for a place beside a model, which is adequate or not.
    pub fn race_from<'c>(&'c self, base: &'c Fit, base_validation: &'c Fit, base_is_adequate: bool) -> Race<'c> {
        let settings = self.settings;
        let least_gain = if base_is_adequate { settings.least_gain_when_adequate } else { settings.least_gain };
        Race {
            base,
            base_validation,
            base_is_adequate,
            identification: self.identification,
            validation: self.validation,
            least_gain,
            settings,
        }
    }
}

/// `candidates`, those of these names and sites marked as tied.
fn with_ties(mut candidates: Vec<Candidate>, tied: &[(&str, Site)]) -> Vec<Candidate> {
    for candidate in &mut candidates {
        candidate.tied_with_first |= tied.contains(&(candidate.name(), candidate.site));
    }
    candidates
}
