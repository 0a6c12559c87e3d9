//! From terms to the laws that are worth a fit.

use excavator_model::effects::Site;

use super::screening::{Screened, Screening};
use super::term::Sized;

/// A law that is worth a fit.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    /// Where it acts.
    pub site: Site,
    /// Its terms, in one row.
    pub terms: Vec<Sized>,
    /// Evidence of the regression.
    pub evidence: f64,
}

/// Most laws of one, two and three terms in a shortlist.
const MOST: [usize; 3] = [20, 4, 2];

/// Terms more alike than this differ by what one recording hardly shows.
const ALIKE: f64 = 0.98;

/// So many of these are fitted in any case, and beside them whatever is simpler than they are.
const MOST_ALIKE: usize = 3;

/// Terms more alike than this are the same, written in two ways.
const SAME: f64 = 0.999_999;

/// Terms from which pairs, and pairs from which triples begin.
const BEGINNINGS: [usize; 2] = [20, 4];

/// Evidence by which a further term must improve a law: a factor of 20 000 in likelihood, for a regression on rows that are not quite
/// independent.
const LEAST_STEP: f64 = 10.0;

/// The laws that are worth a fit, the best of each number of terms.
pub(super) fn shortlist(screening: &Screening) -> Vec<Candidate> {
    let singles = distinct(screening, screening.best.iter().filter(|one| one.evidence > 0.0));
    let mut listed: Vec<Candidate> = singles.iter().take(MOST[0]).map(|one| single(one)).collect();
    let firsts: Vec<Vec<usize>> = (0..screening.best.len().min(BEGINNINGS[0])).map(|index| vec![index]).collect();
    let pairs = extended(screening, &firsts);
    let triples =
        extended(screening, &pairs.iter().take(BEGINNINGS[1]).map(|(_, all)| all.clone()).collect::<Vec<_>>());
    for (laws, most) in [(pairs, MOST[1]), (triples, MOST[2])] {
        let mut seen: Vec<String> = Vec::new();
        for (candidate, _) in laws {
            let name = name(&candidate);
            if !seen.contains(&name) && seen.len() < most {
                seen.push(name);
                listed.push(candidate);
            }
        }
    }
    listed
}

fn single(one: &Screened) -> Candidate {
    Candidate { site: one.site, terms: vec![one.sized.clone()], evidence: one.evidence }
}

/// Kinds of terms without their numbers.
fn name(candidate: &Candidate) -> String {
    let mut words: Vec<&str> =
        candidate.terms.iter().flat_map(|sized| sized.term.factors.iter().map(|factor| factor.text)).collect();
    words.sort_unstable();
    format!("{:?} {}", candidate.site, words.join(" "))
}

/// Terms that differ, each with its best numbers: of those that are alike only the first few.
fn distinct<'a>(screening: &Screening, terms: impl Iterator<Item = &'a Screened>) -> Vec<&'a Screened> {
    let mut kept: Vec<&Screened> = Vec::new();
    for term in terms {
        let is_same = |other: &&&Screened| other.site == term.site && other.sized.term == term.sized.term;
        if kept.iter().any(|other| is_same(&other)) {
            continue;
        }
        let likeness = |other: &Screened| screening.projection.likeness(&other.column, &term.column);
        let complexity = |one: &Screened| (one.sized.term.parameters(), one.sized.term.length());
        if let Some(same) = kept.iter_mut().find(|other| likeness(other) > SAME) {
            if complexity(term) < complexity(same) {
                *same = term;
            }
            continue;
        }
        let alike = kept.iter().filter(|other| likeness(other) > ALIKE);
        if alike.clone().count() < MOST_ALIKE || alike.clone().all(|other| complexity(term) < complexity(other)) {
            kept.push(term);
        }
        if kept.len() >= MOST[0] {
            break;
        }
    }
    kept
}

/// Laws with one more term in the same row, with the numbers of their terms, the best first. Each has to be better than the law that it
/// extends, and than each of its terms.
fn extended(screening: &Screening, laws: &[Vec<usize>]) -> Vec<(Candidate, Vec<usize>)> {
    let Screening { projection, best, cost_of_parameter } = screening;
    let cost_of_search = (best.len().max(1) as f64).ln();
    let evidence = |numbers: &[usize]| {
        let columns: Vec<_> = numbers.iter().map(|&number| &best[number].column).collect();
        let (coefficients, gain) = projection.gain(&columns)?;
        let parameters: usize = numbers.iter().map(|&number| best[number].sized.term.parameters()).sum();
        Some((coefficients, gain - cost_of_parameter * parameters as f64 - cost_of_search * numbers.len() as f64))
    };
    let mut found: Vec<(Candidate, Vec<usize>)> = Vec::new();
    for law in laws {
        let Some((_, own)) = evidence(law) else { continue };
        let first = &best[law[0]];
        for number in 0..best.len() {
            let fits = best[number].site == first.site && best[number].sized.term.row == first.sized.term.row;
            // One kind of term twice, with two positions or two widths, is a curve and no law.
            let is_new = law.iter().all(|&other| best[other].sized.term != best[number].sized.term);
            let is_force = |number: usize| best[number].sized.term.is_a_force_of_pressure();
            let has_force = law.iter().chain([&number]).any(|&number| is_force(number));
            if !fits || !is_new || has_force {
                continue;
            }
            let numbers: Vec<usize> = law.iter().copied().chain([number]).collect();
            let Some((coefficients, evidence)) = evidence(&numbers) else { continue };
            let least = numbers.iter().map(|&number| best[number].evidence).fold(own, f64::max) + LEAST_STEP;
            if evidence > least {
                let terms = numbers.iter().zip(coefficients);
                let terms = terms.map(|(&number, coefficient)| Sized { coefficient, ..best[number].sized.clone() });
                found.push((Candidate { site: first.site, terms: terms.collect(), evidence }, numbers));
            }
        }
    }
    found.sort_by(|a, b| b.0.evidence.total_cmp(&a.0.evidence));
    found
}
