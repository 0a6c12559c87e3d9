//! Presents the hypotheses of a diagnosis as a list of effects.

use excavator_model::{ModelEffect, site_name};

use super::Diagnosis;
use crate::decision::{Standing, presence};
use crate::search::{Addition, Trial};

/// Role of an effect in a verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The first effect of the favoured hypothesis, or a further one.
    Selected,
    /// It belongs to a hypothesis that cannot be distinguished from the favoured one.
    Tied,
    /// It improves the given model, but less.
    Improves,
    /// There is no evidence for it.
    NoEvidence,
}

/// An effect that was tried.
#[derive(Debug, Clone, Copy)]
pub struct Candidate<'a> {
    /// The effect and its place.
    pub addition: &'a Addition,
    /// The fit that includes it.
    pub trial: &'a Trial,
    /// The fit that `trial` is compared with.
    pub before: &'a Trial,
    /// How the hypothesis of its fit compares with the given model.
    pub standing: Standing,
    /// Decrease of the log error ratio from `before` to `trial`.
    pub improvement: f64,
    /// Mean NMSE of both on the validation recordings, as in [`Trial::error`]: before, with it.
    pub errors: [Option<f64>; 2],
    /// Its role in the verdict.
    pub part: Part,
    /// Whether it shares the first place with others.
    pub is_tied_with_first: bool,
}

impl<'a> Candidate<'a> {
    /// Name in the catalogue.
    pub fn name(&self) -> &'a str {
        &self.addition.physics.card().name
    }

    /// Name of the place.
    pub fn place(&self) -> &str {
        site_name(&self.trial.fit.model.machine, self.addition.site)
    }

    /// Its role in the verdict, in a word or two.
    pub fn result(&self) -> &'static str {
        match self.part {
            _ if self.is_tied_with_first => "tied",
            Part::Tied => "tied",
            Part::Selected if self.before.additions.is_empty() => "selected",
            Part::Selected => "selected too",
            Part::Improves => "helps less",
            Part::NoEvidence => "no evidence",
        }
    }

    /// The effect with its fitted parameters.
    pub fn effect(&self) -> Option<&ModelEffect> {
        self.trial.effect(self.addition)
    }
}

impl Diagnosis {
    /// The given model, refitted.
    pub fn given(&self) -> &Trial {
        &self.trials[0]
    }

    /// The favoured hypothesis; the given model if there is none.
    pub fn best(&self) -> &Trial {
        &self.trials[self.verdict.best]
    }

    /// The hypothesis whose effects a refinement adds; the given model if there is none.
    pub fn supported(&self) -> &Trial {
        &self.trials[self.verdict.supported()]
    }

    /// Numbers of the given model and of the hypotheses on the path to the supported one.
    pub(super) fn on_paths(&self) -> Vec<usize> {
        std::iter::once(0).chain(self.path(self.verdict.supported())).collect()
    }

    /// Numbers of the trials that are shown to users.
    pub(super) fn shown(&self) -> Vec<usize> {
        let singles = (0..self.trials.len()).filter(|&number| self.trials[number].additions.len() == 1);
        let mut shown: Vec<usize> =
            self.on_paths().into_iter().chain(self.path(self.verdict.best)).chain(singles).collect();
        shown.extend(self.verdict.set.iter().copied().chain(self.verdict.structural_alternative()));
        shown.sort_unstable();
        shown.dedup();
        shown
    }

    /// Number of effects that were tried; none if the given model leaves only noise.
    pub fn tried(&self) -> usize {
        let singles = self.trials.iter().filter(|trial| trial.additions.len() == 1).count();
        singles + self.unpromising.len() + self.failed.len()
    }

    /// Numbers of the hypotheses from the first effect to hypothesis `number`, each with one more effect than the previous one.
    pub fn path(&self, number: usize) -> Vec<usize> {
        let mut path = Vec::new();
        let mut next = Some(number).filter(|&number| number != 0);
        while let Some(number) = next {
            path.insert(0, number);
            let own = &self.scores.hypotheses[number];
            next = (1..self.trials.len())
                .filter(|&less| {
                    let other = &self.scores.hypotheses[less];
                    own.extends(other) && other.effects.len() + 1 == own.effects.len() && !other.is_structural()
                })
                .min_by(|&a, &b| self.ratio(a).total_cmp(&self.ratio(b)));
        }
        path
    }

    /// Effects of the supported hypothesis, in the order of its path.
    pub fn selected(&self) -> Vec<Candidate<'_>> {
        self.selected_of(self.verdict.supported())
    }

    fn selected_of(&self, number: usize) -> Vec<Candidate<'_>> {
        let path = self.path(number);
        let befores = std::iter::once(0).chain(path.iter().copied());
        let each = path.iter().zip(befores);
        each.flat_map(|(&number, before)| {
            let known = &self.trials[before];
            let new = self.trials[number].additions.iter().filter(|addition| !known.adds(addition));
            new.map(move |addition| self.candidate(addition, [before, number], Part::Selected))
        })
        .collect()
    }

    /// Probability that an effect is there; `None` if no hypothesis has it.
    pub fn presence_of(&self, candidate: &Candidate<'_>) -> Option<f64> {
        let mut effects = self.scores.hypotheses.iter().flat_map(|hypothesis| &hypothesis.effects);
        let own = effects.find(|one| one.effect == candidate.name() && one.place == candidate.place())?;
        Some(presence(&self.scores, &self.verdict, own, &self.policy))
    }

    /// Effects that replace another one in hypotheses which cannot be distinguished from the favoured one, each with the effect
    /// that it replaces. An alternative without a counterpart replaces the first effect.
    pub fn alternatives(&self) -> Vec<(Candidate<'_>, &Addition)> {
        let best = self.best();
        let order: Vec<&Addition> = self.selected_of(self.verdict.best).iter().map(|one| one.addition).collect();
        let others = self.verdict.set.iter().filter(|&&number| number != self.verdict.best);
        let structural = self.verdict.structural_alternative();
        let mut found: Vec<(Candidate<'_>, &Addition)> = Vec::new();
        for &number in others.chain(structural.iter()) {
            let trial = &self.trials[number];
            let replaced = order.iter().find(|one| !trial.adds(one)).or(order.first());
            let Some(&replaced) = replaced else { continue };
            for addition in trial.additions.iter().filter(|addition| !best.adds(addition)) {
                if !found.iter().any(|(known, _)| known.addition == addition) {
                    found.push((self.candidate(addition, [0, number], Part::Tied), replaced));
                }
            }
        }
        found
    }

    /// All effects with evidence: the selected effects, those tied with the first of them, and others that improve the given
    /// model, best first.
    pub fn candidates(&self) -> Vec<Candidate<'_>> {
        let mut listed: Vec<Candidate<'_>> = self.selected_of(self.verdict.best);
        let first = listed.first().map(|first| first.addition);
        let tied: Vec<Candidate<'_>> = self
            .alternatives()
            .into_iter()
            .filter(|(_, replaced)| Some(*replaced) == first)
            .map(|(candidate, _)| Candidate { is_tied_with_first: true, ..candidate })
            .collect();
        if let Some(first) = listed.first_mut() {
            first.is_tied_with_first = !tied.is_empty();
        }
        let after_the_first = listed.len().min(1);
        listed.splice(after_the_first..after_the_first, tied);
        let others = self.singles().into_iter().filter(|one| one.part == Part::Improves);
        let others: Vec<Candidate<'_>> =
            others.filter(|one| !listed.iter().any(|other| other.addition == one.addition)).collect();
        listed.extend(others);
        listed
    }

    /// Effects that were fully fitted, alone, and have no evidence, the best first.
    pub fn rejected(&self) -> Vec<Candidate<'_>> {
        let listed = self.candidates();
        let others = self.singles().into_iter().filter(|one| one.part == Part::NoEvidence);
        others.filter(|one| !listed.iter().any(|other| other.addition == one.addition)).collect()
    }

    /// Single candidates of the catalogue, best first.
    fn singles(&self) -> Vec<Candidate<'_>> {
        let mut singles: Vec<Candidate<'_>> = (1..self.trials.len())
            .filter(|&number| {
                self.trials[number].additions.len() == 1 && !self.scores.hypotheses[number].is_structural()
            })
            .map(|number| {
                let part = if self.verdict.standings[number].is_admissible { Part::Improves } else { Part::NoEvidence };
                self.candidate(&self.trials[number].additions[0], [0, number], part)
            })
            .collect();
        singles.sort_by(|a, b| b.improvement.total_cmp(&a.improvement));
        singles
    }

    /// A candidate from the numbers of the hypotheses without it and with it.
    fn candidate<'a>(&'a self, addition: &'a Addition, numbers: [usize; 2], part: Part) -> Candidate<'a> {
        let [before, trial] = numbers.map(|number| &self.trials[number]);
        let [less, standing] = numbers.map(|number| self.verdict.standings[number]);
        let improvement = less.log_error_ratio - standing.log_error_ratio;
        let errors = [before.error, trial.error];
        Candidate { addition, trial, before, standing, improvement, errors, part, is_tied_with_first: false }
    }

    fn ratio(&self, number: usize) -> f64 {
        self.verdict.standings[number].log_error_ratio
    }
}
