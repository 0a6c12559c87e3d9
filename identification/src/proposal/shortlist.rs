//! From terms to the laws that are worth a fit.

use excavator_model::Model;
use excavator_model::effects::Site;
use excavator_model::recording::Recording;

use super::grammar::Sized;
use super::promise::{Promised, combined, promised};
use super::screening::{Screened, Screening};
use crate::fit::FitSettings;

/// A law that is worth a fit.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    /// Where it acts.
    pub site: Site,
    /// Its terms, in one row.
    pub terms: Vec<Sized>,
    /// Evidence of the regression on the equations.
    pub evidence: f64,
}

impl Candidate {
    /// Whether it is a law of its own and no sum of products.
    fn is_whole(&self) -> bool {
        self.terms.iter().any(|sized| sized.term.is_whole())
    }
}

/// Most laws of one term by what they promise, by evidence of the equations, and of several terms. The equations are right where an effect is
/// large and its outputs far from linear; the outputs where it is small.
const MOST: [usize; 3] = [12, 4, 4];

/// Share of the loss that the best term promises from which on the promises are believed.
const LARGE_SHARE: f64 = 0.5;

/// Most laws that resist the motion, in any case: what pushes it where the rest of the friction became too large often promises more.
const RESISTING: usize = 4;

/// Share of the best promise from which on a law that is no product is fitted: a step from zero foretells less of it than it brings.
const BENT_SHARE: f64 = 0.3;

/// Terms from which laws of several are made.
const COMBINED: usize = 24;

/// Terms more alike than this differ by what one recording hardly shows.
const ALIKE: f64 = 0.98;

/// So many of these are fitted in any case, and beside them whatever is simpler than they are.
const MOST_ALIKE: usize = 3;

/// Terms more alike than this are the same, written in two ways.
const SAME: f64 = 0.999_999;

/// What is worth a fit.
pub(super) struct Shortlist<'a> {
    screening: &'a Screening,
    /// What every term promises, the best first.
    pub foretold: Vec<Promised>,
    /// Laws of one term.
    pub singles: Vec<Candidate>,
}

impl<'a> Shortlist<'a> {
    /// Of the terms of a screening, where the fitted `model` has this loss.
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

    /// Laws of several terms in one row that promise more than any term alone.
    pub fn several(&self, model: &Model, identification: &[&Recording], settings: &FitSettings) -> Vec<Candidate> {
        let best = distinct(self.screening, self.foretold.iter().map(|one| &one.candidate), COMBINED);
        let best: Vec<Candidate> = best.into_iter().cloned().collect();
        let most = self.foretold.first().map_or(0.0, |one| one.improvement);
        let laws = combined(model, &best, identification, settings).into_iter();
        let better = laws.filter(|law| law.improvement > most + LEAST_GAIN).take(MOST[2]);
        better.map(|law| law.candidate).collect()
    }
}

/// Fall of the loss that several terms must promise beyond the best single one.
const LEAST_GAIN: f64 = 0.05;

fn extend(listed: &mut Vec<Candidate>, more: Vec<&Candidate>) {
    for one in more {
        let is_there = |other: &Candidate| other.site == one.site && is_same_kind(other, one);
        if !listed.iter().any(is_there) {
            listed.push(one.clone());
        }
    }
}

/// Terms beside the best products that differ in what they multiply by the same, with the same sign: speed, its sign and its root look alike as long as a model
/// is far off.
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

/// Best products whose siblings are fitted too.
const WITH_SIBLINGS: usize = 5;

/// Siblings of each, itself among them.
const SIBLINGS: usize = 4;

fn single(one: &Screened) -> Candidate {
    Candidate { site: one.site, terms: vec![one.sized.clone()], evidence: one.evidence }
}

/// Whether two laws have the same terms with the same signs, whatever their numbers.
fn is_same_kind(one: &Candidate, other: &Candidate) -> bool {
    one.terms.len() == other.terms.len()
        && one.terms.iter().zip(&other.terms).all(|(one, other)| one.is_same_kind(other))
}

/// Terms that differ, each with the numbers with which it comes first: of those that are alike only the first few.
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
        // A law that is no product is like one only where it is small.
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
