//! Selects the laws that are worth a fit from the screened terms.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::grammar::Sized;
use super::law_candidate::Candidate;
use super::promise::{Promised, combined, promised};
use super::screening::{Screened, Screening};
use crate::fit::FitSettings;

/// Largest number of laws: of one term by prediction, of one term by evidence of the equations, and of several terms.
/// The equations are right where an effect is large and the outputs far from linear in it. The predictions for the
/// outputs are right where it is small.
const MOST: [usize; 3] = [12, 4, 4];

/// If the best term is predicted to remove at least this share of the loss, the predictions are trusted.
const LARGE_SHARE: f64 = 0.5;

/// Largest number of laws that resist the motion. They are always included: if the fitted friction became too large, a
/// law that pushes the motion often has the better prediction.
const RESISTING: usize = 4;

/// A whole law is fitted if its prediction is at least this share of the best one. A step from zero predicts less than
/// such a law achieves.
const BENT_SHARE: f64 = 0.3;

/// Number of terms from which laws of several terms are combined.
const COMBINED: usize = 24;

/// Terms more similar than this are hardly separable in one recording.
const ALIKE: f64 = 0.98;

/// Number of similar terms that are always fitted. Beyond that only terms that are simpler than all of these are added.
const MOST_ALIKE: usize = 3;

/// Terms more similar than this are the same term in two notations.
const SAME: f64 = 0.999_999;

/// Laws that are worth a fit.
pub(super) struct Shortlist<'a> {
    screening: &'a Screening,
    /// Predictions for all terms, the best first.
    pub foretold: Vec<Promised>,
    /// Laws of one term.
    pub singles: Vec<Candidate>,
}

impl<'a> Shortlist<'a> {
    /// Selects from the terms of a screening; `loss` is that of the fitted `model`.
    pub fn new(
        model: &Model,
        loss: f64,
        screening: &'a Screening,
        identification: &[&Recording],
        settings: &FitSettings,
    ) -> Self {
        let all: Vec<Candidate> = screening.best.iter().map(single).collect();
        let foretold = promised(model, &all, identification, settings);
        let mut singles: Vec<Candidate> = Vec::new();
        let resisting = foretold.iter().filter(|one| one.improvement > 0.0).map(|one| &one.candidate);
        let resisting = resisting.filter(|one| one.terms.iter().all(|sized| sized.resists()));
        extend(&mut singles, distinct(screening, resisting, RESISTING));
        let by_promise = foretold.iter().filter(|one| one.improvement > 0.0).map(|one| &one.candidate);
        extend(&mut singles, distinct(screening, by_promise, MOST[0]));
        let beside = siblings(&singles, &foretold);
        extend(&mut singles, beside);
        let most = foretold.first().map_or(0.0, |one| one.improvement);
        let bent = foretold.iter().filter(|one| one.candidate.is_whole() && one.improvement > BENT_SHARE * most);
        extend(&mut singles, bent.map(|one| &one.candidate).collect());
        if most < LARGE_SHARE * loss {
            let by_evidence = all.iter().filter(|one| one.evidence > 0.0);
            extend(&mut singles, distinct(screening, by_evidence, MOST[1]));
        }
        Shortlist { screening, foretold, singles }
    }

    /// Laws of several terms in one row with a better prediction than any single term.
    pub fn several(&self, model: &Model, identification: &[&Recording], settings: &FitSettings) -> Vec<Candidate> {
        let best = distinct(self.screening, self.foretold.iter().map(|one| &one.candidate), COMBINED);
        let best: Vec<Candidate> = best.into_iter().cloned().collect();
        let most = self.foretold.first().map_or(0.0, |one| one.improvement);
        let laws = combined(model, &best, identification, settings).into_iter();
        let better = laws.filter(|law| law.improvement > most + LEAST_GAIN).take(MOST[2]);
        better.map(|law| law.candidate).collect()
    }
}

/// Predicted decrease of the loss by which several terms must exceed the best single one.
const LEAST_GAIN: f64 = 0.05;

fn extend(listed: &mut Vec<Candidate>, more: Vec<&Candidate>) {
    for one in more {
        let is_there = |other: &Candidate| other.site == one.site && is_same_kind(other, one);
        if !listed.iter().any(is_there) {
            listed.push(one.clone());
        }
    }
}

/// Siblings of the best products: terms with another first factor, the same second factor and the same sign. Speed, its
/// sign and its root look alike as long as a model is far off.
fn siblings<'a>(singles: &[Candidate], foretold: &'a [Promised]) -> Vec<&'a Candidate> {
    let products = singles.iter().filter(|one| one.terms.first().is_some_and(|sized| sized.term.is_product()));
    let of_one = |one: &Candidate| {
        let alike = |one: &Candidate| {
            let of_term = |sized: &Sized| (sized.term.row, sized.term.factors[1], sized.coefficient.is_sign_negative());
            (one.site, one.terms.first().map(of_term))
        };
        let own = alike(one);
        let is_sibling = move |other: &&Candidate| alike(other) == own;
        let mut kinds: Vec<&Candidate> = Vec::new();
        for other in foretold.iter().map(|one| &one.candidate).filter(is_sibling) {
            if !kinds.iter().any(|known| is_same_kind(known, other)) {
                kinds.push(other);
            }
        }
        kinds.truncate(SIBLINGS);
        kinds
    };
    products.take(WITH_SIBLINGS).flat_map(of_one).collect()
}

/// Number of best products whose siblings are fitted too.
const WITH_SIBLINGS: usize = 5;

/// Number of siblings of each product, including itself.
const SIBLINGS: usize = 4;

fn single(one: &Screened) -> Candidate {
    Candidate { site: one.site, terms: vec![one.sized.clone()], evidence: one.evidence }
}

/// Whether two laws have the same terms with the same signs, apart from their numbers.
fn is_same_kind(one: &Candidate, other: &Candidate) -> bool {
    one.terms.len() == other.terms.len()
        && one.terms.iter().zip(&other.terms).all(|(one, other)| one.is_same_kind(other))
}

/// Distinct terms, each with the numbers of its first occurrence. Of similar terms only the first few are kept.
fn distinct<'a>(screening: &Screening, terms: impl Iterator<Item = &'a Candidate>, most: usize) -> Vec<&'a Candidate> {
    let column = |one: &Candidate| {
        let is_it =
            |screened: &&Screened| screened.site == one.site && one.terms.first().is_some_and(|term| screened.is(term));
        screening.best.iter().find(is_it).map(|screened| &screened.column)
    };
    let likeness = |one: &Candidate, other: &Candidate| match (column(one), column(other)) {
        (Some(one), Some(other)) => screening.projection.likeness(one, other),
        _ => 0.0,
    };
    let complexity = |one: &Candidate| one.terms.first().map(|sized| (sized.term.parameters(), sized.term.length()));
    let mut kept: Vec<&Candidate> = Vec::new();
    for term in terms {
        if kept.iter().any(|other| other.site == term.site && is_same_kind(other, term)) {
            continue;
        }
        // A whole law resembles a product only where it is small.
        let is_same = |other: &Candidate| likeness(other, term) > SAME && other.is_whole() == term.is_whole();
        if let Some(same) = kept.iter_mut().find(|other| is_same(other)) {
            if complexity(term) < complexity(same) {
                *same = term;
            }
            continue;
        }
        let alike: Vec<&&Candidate> = kept.iter().filter(|other| likeness(other, term) > ALIKE).collect();
        if alike.len() < MOST_ALIKE || alike.iter().all(|other| complexity(term) < complexity(other)) {
            kept.push(term);
        }
        if kept.len() >= most {
            break;
        }
    }
    kept
}
