//! Confidence in a choice: its evidence, and alternatives that are nearly as good.

use std::collections::HashSet;

use super::super::signal::SignalName;
use super::Confidence;
use super::pair::Pair;

/// From this score, name, unit and shape together are sufficient.
const SURE_SCORE: f64 = 0.75;
/// A smaller difference in score does not decide between two candidates.
const LEAST_MARGIN: f64 = 0.1;
/// Below this score, a candidate is not an alternative.
const LEAST_ALTERNATIVE: f64 = 0.25;
/// Maximum number of alternatives listed.
const MOST_ALTERNATIVES: usize = 5;

/// The confidence in the pair at `place`, and a remark. `used` are the candidates of better pairs.
pub(super) fn confidence(
    pairs: &[Pair],
    place: usize,
    used: &HashSet<usize>,
    name_of: &dyn Fn(&Pair) -> SignalName,
) -> (Confidence, String) {
    let pair = &pairs[place];
    let name = name_of(pair);
    if pair.is_weak {
        return (Confidence::Unsure, String::new());
    }
    let is_near = |other: &&Pair| other.score > pair.score - LEAST_MARGIN;
    let best_elsewhere = |candidate: usize| {
        let elsewhere = pairs.iter().filter(|other| other.candidate == candidate && name_of(other) != name);
        elsewhere.map(|other| other.score).fold(0.0, f64::max)
    };
    let rivals = pairs
        .iter()
        .filter(|other| other.candidate != pair.candidate && !used.contains(&other.candidate) && name_of(other) == name)
        .filter(is_near)
        // A candidate that fits another signal better is not a rival.
        .filter(|other| best_elsewhere(other.candidate) < other.score + LEAST_MARGIN)
        .count();
    if rivals > 0 {
        let are = if rivals == 1 { "another is as likely" } else { "others are as likely" };
        return (Confidence::Unsure, format!("; {are}"));
    }
    let best_of = |wanted: &SignalName| {
        let others = pairs.iter().filter(|other| other.candidate != pair.candidate && name_of(other) == *wanted);
        others.map(|other| other.score).fold(0.0, f64::max)
    };
    let mut of_same = pairs.iter().filter(|other| other.candidate == pair.candidate && name_of(other) != name);
    // Another signal that has no better candidate is equally possible.
    if let Some(other) = of_same.find(|other| is_near(other) && best_of(&name_of(other)) <= other.score) {
        return (Confidence::Unsure, format!("; it may be {} as well", name_of(other)));
    }
    let sure = pair.score >= SURE_SCORE;
    (if sure { Confidence::Sure } else { Confidence::Likely }, String::new())
}

/// Other candidates for the signal of the pair at `place`, best first, without those of sure signals.
pub(super) fn alternatives<'p>(
    pairs: &'p [Pair],
    place: usize,
    sure: &HashSet<usize>,
    name_of: &dyn Fn(&Pair) -> SignalName,
) -> Vec<&'p Pair> {
    let (own, name) = (&pairs[place], name_of(&pairs[place]));
    let mut seen = HashSet::from([own.candidate]);
    pairs
        .iter()
        .filter(|pair| name_of(pair) == name && pair.score >= LEAST_ALTERNATIVE && !sure.contains(&pair.candidate))
        .filter(|pair| seen.insert(pair.candidate))
        .take(MOST_ALTERNATIVES)
        .collect()
}
