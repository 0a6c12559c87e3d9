//! Effects added one after the other.
//!
//! The effect that lowers the error most need not be one that is missing: where two are, something in between may look
//! better than either. So when the first way leads nowhere, the runner-up is tried as a first step too.

use excavator_model::recording::Recording;

use super::race::{Race, Round};
use super::{Candidate, DiagnosisError, DiagnosisSettings, additions, is_adequate};
use crate::fit::Fit;

/// A gain below this part of the best one's is no other way to begin.
const OTHER_WAY: f64 = 0.5;

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
    /// The best chain, and all candidates of its first step.
    ///
    /// # Errors
    /// [`DiagnosisError`] when a model cannot be evaluated.
    pub fn best(&self, progress: &(dyn Fn(&str, f64) + Sync)) -> Result<(Vec<Candidate>, Round), DiagnosisError> {
        let round = self.round(&[], progress)?;
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
        Ok((chain, round))
    }

    /// Whether a chain of effects explains the recordings: the model is adequate with them, or so much better and good
    /// enough.
    pub fn explains(&self, chain: &[Candidate]) -> bool {
        let settings = self.settings;
        let Some(last) = chain.last().map(|last| &last.validation) else {
            return self.nominal_is_adequate;
        };
        is_adequate(last, self.validation, settings)
            || last.typical_loss() <= settings.explained_loss
                && last.loss() <= (1.0 - settings.explained_share) * self.nominal_validation.loss()
    }

    fn contains(&self, chain: &[Candidate], other: &Candidate) -> bool {
        chain.iter().any(|link| link.name() == other.name() && link.place == other.place)
    }

    /// The chain that begins with `first`, until nothing more is gained.
    fn grow(&self, first: Candidate, progress: &(dyn Fn(&str, f64) + Sync)) -> Result<Vec<Candidate>, DiagnosisError> {
        let mut chain = vec![first];
        while chain.len() < self.settings.most_effects
            && !chain.last().is_some_and(|last| is_adequate(&last.validation, self.validation, self.settings))
        {
            let best = self.round(&chain, progress)?.fitted.into_iter().find(|candidate| candidate.accepted);
            match best {
                Some(best) => chain.push(best),
                None => break,
            }
        }
        Ok(chain)
    }

    /// All additions to a chain.
    fn round(&self, chain: &[Candidate], progress: &(dyn Fn(&str, f64) + Sync)) -> Result<Round, DiagnosisError> {
        let settings = self.settings;
        let (base, base_validation, adequate) = match chain.last() {
            Some(last) => (&last.fit, &last.validation, is_adequate(&last.validation, self.validation, settings)),
            None => (self.nominal, self.nominal_validation, self.nominal_is_adequate),
        };
        let least_gain = if adequate { settings.least_gain_when_adequate } else { settings.least_gain };
        let race = Race {
            base,
            base_validation,
            identification: self.identification,
            validation: self.validation,
            least_gain,
            settings,
        };
        let start = 0.15 + 0.8 * chain.len() as f64 / settings.most_effects as f64;
        let span = 0.8 / settings.most_effects as f64;
        Ok(race.run(&additions(&base.model), &|what, fraction| progress(what, start + span * fraction))?)
    }
}
