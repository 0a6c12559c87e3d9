//! Compares terms of the grammar with a model that has them as laws.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::Site;
use excavator_model::formula::{Law, Row};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};

use super::grammar::{GROWING, OPENING, PAST_THE_PISTON, REMEMBERING, RESISTING, SHIFTING, Sized, Term, law_text};
use super::law_candidate::Candidate;
use super::promise::promised;
use super::screening::{Evaluated, probed};
use crate::fit::FitSettings;
use crate::regression::{WeakFormSettings, weak_terms};

const SITE: Site = Site::Cylinder(0);

/// The arm with a term as a law. Its coefficient is `value` and free, its shapes are held.
fn with_law(model: &Model, sized: &Sized, value: f64) -> Model {
    let law = Law::read(&law_text(std::slice::from_ref(sized), "").unwrap()).unwrap();
    let mut extended = model.with_effect(&(Arc::new(law) as _), SITE).unwrap();
    for parameter in &mut extended.effects.last_mut().unwrap().parameters {
        let is_coefficient = parameter.card.name == "k";
        parameter.value = if is_coefficient { value } else { parameter.value };
        parameter.known = !is_coefficient;
    }
    extended
}

/// Six noise-free seconds of the arm of `model`, driven by two sines.
fn swing(model: &Model) -> Recording {
    let time: Vec<f64> = (0..3000).map(|index| f64::from(index) * 2e-3).collect();
    let mut recording = Recording::unmeasured("swing", time, &["arm"]);
    recording.tank_pressure.fill(3e5);
    recording.pump_flow.fill(3.8e-4);
    let area = |t: &f64| 5e-5 * (3.1 * t).sin() + 3e-5 * (7.3 * t).sin();
    recording.cylinders[0].orifice_area = recording.time.iter().map(area).collect();
    simulate_from_rest(model, &recording, &[0.1], Tolerances::default().scaled(0.05)).unwrap()
}

fn sized(term: Term, shapes: &[f64], coefficient: f64) -> Sized {
    Sized { term, shapes: shapes.to_vec(), coefficient, cylinder: "arm".into() }
}

/// Terms in several rows, with and without shapes and memory, and a coefficient that is small for each.
fn some() -> Vec<Sized> {
    let growing = |word: &str| GROWING.iter().find(|factor| factor.word == word).unwrap();
    let shifting = |word: &str| SHIFTING.iter().find(|factor| factor.word == word).unwrap();
    vec![
        sized(Term::product(Row::PistonForce, &RESISTING[0], growing("abs_position")), &[], 50.0),
        sized(Term::product(Row::PistonForce, &RESISTING[1], growing("abs_load")), &[], 1e-4),
        sized(Term::product(Row::PistonLeak, &PAST_THE_PISTON[2], growing("beyond")), &[0.05], 1e-19),
        sized(Term::product(Row::Opening, &OPENING[0], shifting("pump_pressure")), &[], 1e-9),
        sized(Term::of(Row::PistonForce, &REMEMBERING[1]), &[0.1], 100.0),
    ]
}

#[test]
fn the_regressor_of_a_term_is_that_of_its_law() {
    let model = built_in("zx30u-arm").unwrap();
    let recording = swing(&model);
    for one in some().into_iter().filter(|one| one.term.factors[0].memory.is_empty()) {
        let with = with_law(&model, &one, 0.0);
        let (probed, probes, entries) = probed(&with);
        let terms = weak_terms(&probed, probes, &[&recording], &WeakFormSettings::default()).unwrap();
        let entry = entries.iter().copied().find(|entry| entry.is(one.term.row, SITE)).unwrap();
        let law = Evaluated::new(&probed, entry, one.term, &one.shapes).unwrap();
        let found = terms.regressor(entry.probe, &law.values(&terms)).unwrap();
        let own = terms.regressors.column(terms.regressors.ncols() - 1);
        let size = own.amax();
        assert!(size > 0.0 && found.len() > 1000);
        for (found, own) in found.iter().zip(own.iter()) {
            assert!((found - own).abs() < 1e-6 * size, "{}: {found} {own}", law_text(&[one], "").unwrap().formula);
        }
    }
}

#[test]
fn what_is_promised_of_a_small_law_is_its_coefficient() {
    let model = built_in("zx30u-arm").unwrap();
    for one in some() {
        let recording = swing(&with_law(&model, &one, one.coefficient));
        let candidates: Vec<Candidate> =
            some().into_iter().map(|other| Candidate { site: SITE, terms: vec![other], evidence: 0.0 }).collect();
        let promised = promised(&model, &candidates, &[&recording], &FitSettings::default());
        let first = &promised[0].candidate.terms[0];
        assert_eq!(first.term, one.term, "{promised:?}");
        assert!((first.coefficient / one.coefficient - 1.0).abs() < 0.1, "{} {}", first.coefficient, one.coefficient);
    }
}
