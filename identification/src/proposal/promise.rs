//! Predicts which laws would lower the error of simulated outputs, before any is fitted.
//!
//! The equations use derivatives of measured signals. If an effect is small, the noise in these resembles another
//! effect. Simulated outputs have no noise: one simulation with sensitivities shows the result of a small coefficient,
//! for many laws at once.

use std::sync::Arc;

use excavator_model::Model;
use excavator_model::effects::AnyEffect;
use excavator_model::formula::Law;
use excavator_model::recording::Recording;
use rayon::prelude::*;

use super::grammar::{Sized, law_text};
use super::law_candidate::Candidate;
use crate::fit::{FitSettings, Linearised};

/// Number of laws that are simulated together. Each law is evaluated in every direction. All laws together pay once for
/// the directions of the model's own parameters.
const TOGETHER: usize = 20;

/// A law with the predicted result of a step in its coefficients.
#[derive(Debug, Clone)]
pub(super) struct Promised {
    /// The law, with its coefficients after the step.
    pub candidate: Candidate,
    /// Predicted decrease of the loss.
    pub improvement: f64,
}

/// Predicts the improvement by laws of one term, the best first. Laws that cannot be simulated are left out.
pub(super) fn promised(
    model: &Model,
    singles: &[Candidate],
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Vec<Promised> {
    let mut promised: Vec<Promised> = singles
        .par_chunks(TOGETHER)
        .flat_map_iter(|some| {
            let linearised = linearised(model, some, recordings, settings);
            let each = some.iter().enumerate().filter_map(|(number, candidate)| {
                let linearised = linearised.as_ref()?;
                let promise = linearised.promise(&[number])?;
                let terms =
                    candidate.terms.iter().zip(&promise.values).map(|(term, value)| stepped(term, *value)).collect();
                let candidate = Candidate { terms, ..candidate.clone() };
                law_text(&candidate.terms, "")?;
                Some(Promised { candidate, improvement: linearised.loss_before - promise.loss })
            });
            each.collect::<Vec<Promised>>()
        })
        .collect();
    promised.sort_by(|a, b| b.improvement.total_cmp(&a.improvement));
    promised
}

/// Laws of two and three of these terms in one row, with their predictions.
pub(super) fn combined(
    model: &Model,
    singles: &[Candidate],
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Vec<Promised> {
    let Some(linearised) = linearised(model, singles, recordings, settings) else { return Vec::new() };
    let alone: Vec<f64> = (0..singles.len())
        .map(|number| linearised.promise(&[number]).map_or(0.0, |promise| linearised.loss_before - promise.loss))
        .collect();
    let law = |numbers: &[usize]| {
        let promise = linearised.promise(numbers)?;
        let terms = numbers.iter().zip(&promise.values);
        let terms = terms.filter_map(|(&number, value)| Some(stepped(singles[number].terms.first()?, *value)));
        let candidate = Candidate { site: singles[numbers[0]].site, terms: terms.collect(), evidence: 0.0 };
        Some(Promised { candidate, improvement: linearised.loss_before - promise.loss })
    };
    let mut found: Vec<(Vec<usize>, Promised)> = Vec::new();
    let mut beginnings: Vec<(Vec<usize>, f64)> =
        alone.iter().enumerate().map(|(number, &own)| (vec![number], own)).collect();
    for _ in 0..MOST_TERMS - 1 {
        let mut longer: Vec<(Vec<usize>, Promised)> = Vec::new();
        for (numbers, own) in &beginnings {
            for other in numbers.last().map_or(0, |last| last + 1)..singles.len() {
                let all: Vec<usize> = numbers.iter().copied().chain([other]).collect();
                if !fits(singles, &all) {
                    continue;
                }
                let best = all.iter().map(|&number| alone[number]).fold(*own, f64::max);
                longer.extend(law(&all).filter(|law| law.improvement > best + LEAST_STEP).map(|law| (all, law)));
            }
        }
        longer.sort_by(|a, b| b.1.improvement.total_cmp(&a.1.improvement));
        longer.truncate(KEPT);
        beginnings = longer.iter().map(|(numbers, law)| (numbers.clone(), law.improvement)).collect();
        found.extend(longer);
    }
    let mut laws: Vec<Promised> = found.into_iter().map(|(_, law)| law).collect();
    laws.sort_by(|a, b| b.improvement.total_cmp(&a.improvement));
    laws
}

/// A term after a step of its coefficient to `value`, which is relative to the sign in its text.
fn stepped(term: &Sized, value: f64) -> Sized {
    Sized { coefficient: value.copysign(value * term.coefficient), ..term.clone() }
}

/// Largest number of terms in all laws together. More terms would only describe a curve.
pub(super) const MOST_TERMS: usize = 3;

/// Number of laws that are kept and extended for each number of terms.
const KEPT: usize = 6;

/// Smallest predicted decrease of the loss for a further term.
const LEAST_STEP: f64 = 0.03;

/// Whether terms can form one law: products in one row, of different kinds, with at most one force that depends on a
/// pressure.
fn fits(singles: &[Candidate], numbers: &[usize]) -> bool {
    let terms: Vec<&Sized> = numbers.iter().filter_map(|&number| singles[number].terms.first()).collect();
    let first = &singles[numbers[0]];
    numbers.iter().all(|&number| singles[number].site == first.site)
        && !terms.iter().any(|term| term.term.is_whole())
        && terms.iter().all(|term| term.term.row == terms[0].term.row)
        && terms.iter().enumerate().all(|(number, term)| terms[..number].iter().all(|other| other.term != term.term))
        && terms.iter().filter(|term| term.term.is_a_force_of_pressure()).count() < 2
}

/// The model with all of these laws. Their coefficients are zero; their other parameters are held.
fn linearised(
    model: &Model,
    singles: &[Candidate],
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Option<Linearised> {
    let own = model.unknown_parameters();
    let (mut extended, mut further) = (model.clone(), Vec::new());
    for (number, candidate) in singles.iter().enumerate() {
        let mut text = law_text(&candidate.terms, "")?;
        text.name = format!("term_{number}");
        let physics: AnyEffect = Arc::new(Law::read(&text).ok()?);
        extended = extended.with_effect(&physics, candidate.site).ok()?;
        let before = extended.parameter_values().len();
        let law = extended.effects.last_mut()?;
        let count = law.parameters.len();
        for (index, parameter) in law.parameters.iter_mut().enumerate() {
            if parameter.card.name == "k" {
                parameter.value = 0.0;
                further.push(before - count + index);
            }
        }
    }
    Linearised::new(&extended, &own, &further, recordings, settings).ok()
}
