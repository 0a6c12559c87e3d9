//! Which terms explain what a model leaves: a regression on the equations, before any simulation.

use std::sync::Arc;

use excavator_model::Model;
use excavator_model::effects::{AnyEffect, Physics, Site};
use excavator_model::equations::Situation;
use excavator_model::formula::{Law, ROWS, Row};
use excavator_model::recording::Recording;
use rayon::prelude::*;

use super::grammar::terms;
use super::projection::{Column, Projection};
use super::term::{Sized, Term, law_text};
use crate::regression::{RegressionError, WeakFormSettings, WeakTerms, weak_terms};

/// A place where terms enter: a row at a site, with the number of its probe.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    row: Row,
    site: Site,
    probe: usize,
}

/// A term that was tried.
#[derive(Debug, Clone)]
pub(super) struct Screened {
    /// Where it enters.
    pub site: Site,
    /// The term with its best numbers.
    pub sized: Sized,
    /// By how much the logarithm of the likelihood grows with it, less what its parameters and the size of the search cost.
    pub evidence: f64,
    /// It in the rows of the regression.
    pub column: Column,
}

/// All terms at all places of a machine, tried; the best first.
pub(super) struct Screening {
    /// The rows of the regression.
    pub projection: Projection,
    /// The best terms.
    pub best: Vec<Screened>,
    /// What each parameter of a law costs.
    pub cost_of_parameter: f64,
}

/// Terms that are kept for combinations.
const KEPT: usize = 150;

/// Tries all terms on what `model` leaves.
///
/// # Errors
/// [`RegressionError`] when a recording lacks inputs.
pub(super) fn screen(
    model: &Model,
    identification: &[&Recording],
    validation: &[&Recording],
) -> Result<Screening, RegressionError> {
    let (probed, entries) = probed(model);
    let settings = WeakFormSettings::default();
    let fitted = weak_terms(&probed, entries.len(), identification, &settings)?;
    let predicted = weak_terms(&probed, entries.len(), validation, &settings)?;
    let projection = Projection::new(&fitted, &predicted);
    let tries = tries(&entries, &fitted);
    let cost_of_parameter = 0.5 * projection.independent().max(1.0).ln();
    let cost_of_search = (tries.len().max(1) as f64).ln();
    let mut best: Vec<Screened> = tries
        .par_iter()
        .filter_map(|(entry, term, shapes)| {
            let law = Evaluated::new(&probed, *entry, *term, shapes)?;
            let column = projection.column(
                &fitted.regressor(entry.probe, &law.values(&fitted))?,
                &predicted.regressor(entry.probe, &law.values(&predicted))?,
            )?;
            let (coefficients, gain) = projection.gain(&[&column])?;
            let evidence = gain - cost_of_parameter * term.parameters() as f64 - cost_of_search;
            let sized = Sized { term: *term, shapes: shapes.clone(), coefficient: coefficients[0] };
            Some(Screened { site: entry.site, sized, evidence, column })
        })
        .collect();
    best.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    best.truncate(KEPT);
    Ok(Screening { projection, best, cost_of_parameter })
}

/// The model with a probe in every row at every site.
fn probed(model: &Model) -> (Model, Vec<Entry>) {
    let (mut probed, mut entries) = (model.clone(), Vec::new());
    for card in ROWS.iter().filter(|card| !card.row.is_a_reading()) {
        let Some(probe) = probe(card.row) else { continue };
        for site in model.free_sites(&probe) {
            if let Ok(more) = probed.with_effect(&probe, site) {
                probed = more;
                entries.push(Entry { row: card.row, site, probe: entries.len() });
            }
        }
    }
    (probed, entries)
}

/// An effect that adds its parameter to a row.
fn probe(row: Row) -> Option<AnyEffect> {
    let term = Term::of(row, &super::factor::ONE);
    let mut text = law_text(&[Sized { term, shapes: Vec::new(), coefficient: 1.0 }], "")?;
    text.name = format!("probe_{}", row.card().name);
    let parameter = text.parameters.get_mut("k")?;
    (parameter.minimum, parameter.maximum, parameter.start) = (Some(-1.0), Some(1.0), vec![0.0]);
    Some(Arc::new(Law::read(&text).ok()?))
}

/// Every term at every place, with all starts of its shapes.
fn tries(entries: &[Entry], terms_of: &WeakTerms<'_>) -> Vec<(Entry, Term, Vec<f64>)> {
    let terms = terms();
    let mut tries = Vec::new();
    for entry in entries {
        let cylinder = match entry.site {
            Site::Cylinder(cylinder) => cylinder,
            Site::PumpLine | Site::Machine => 0,
        };
        for term in terms.iter().filter(|term| term.row == entry.row) {
            let shapes = term.factors.iter().flat_map(|factor| factor.shapes);
            let mut grid: Vec<Vec<f64>> = vec![Vec::new()];
            for shape in shapes {
                let starts = shape.quantity.starts(shape.levels, &terms_of.situations, cylinder);
                grid = grid
                    .iter()
                    .flat_map(|before| {
                        starts.iter().map(|&start| before.iter().copied().chain([start]).collect::<Vec<f64>>())
                    })
                    .collect();
            }
            tries.extend(grid.into_iter().map(|shapes| (*entry, *term, shapes)));
        }
    }
    tries
}

/// A term with given shapes, to be evaluated.
struct Evaluated {
    law: Law,
    entry: Entry,
    parameters: Vec<f64>,
}

impl Evaluated {
    fn new(model: &Model, entry: Entry, term: Term, shapes: &[f64]) -> Option<Evaluated> {
        let text = law_text(&[Sized { term, shapes: shapes.to_vec(), coefficient: 1.0 }], "")?;
        let law = Law::read(&text).ok()?;
        let cards = law.parameters(&model.machine, entry.site);
        let mut left = shapes.iter();
        let names: Vec<&str> = term.factors.iter().flat_map(|factor| factor.shapes).map(|shape| shape.name).collect();
        let values: Vec<(&str, f64)> = names.into_iter().map(|name| (name, *left.next().unwrap_or(&0.0))).collect();
        let value = |name: &str| values.iter().find(|(known, _)| *known == name).map_or(1.0, |(_, value)| *value);
        let parameters = cards.iter().map(|card| value(&card.name)).collect();
        Some(Evaluated { law, entry, parameters })
    }

    /// Its value for each recording, for each sample.
    fn values(&self, terms: &WeakTerms<'_>) -> Vec<Vec<f64>> {
        let value = |now: &Situation<'_, f64>| {
            let value = self.law.value(self.entry.site, &self.parameters, &[], now);
            match self.entry {
                Entry { row: Row::Opening, site: Site::Cylinder(cylinder), .. } => {
                    value - now.pistons[cylinder].opening
                }
                _ => value,
            }
        };
        terms.situations.iter().map(|situations| situations.iter().map(value).collect()).collect()
    }
}
