//! Finds terms that explain the residual of a model, by a regression on the equations before any simulation.

use std::sync::Arc;

use excavator_model::Model;
use excavator_model::effects::{AnyEffect, Physics, Site};
use excavator_model::equations::Situation;
use excavator_model::formula::{Law, ROWS, Row};
use excavator_model::recording::Recording;
use rayon::prelude::*;

use super::grammar::{ONE, Sized, Term, law_text, terms};
use super::memory::memory_along;
use super::merits::change;
use super::projection::{Column, Projection};
use crate::regression::{RegressionError, WeakFormSettings, WeakTerms, weak_terms};

/// A place where terms enter: a row at a site, with the index of its probe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Entry {
    row: Row,
    site: Site,
    pub(super) probe: usize,
    /// The cylinder that a term there may name.
    cylinder: usize,
}

impl Entry {
    /// Whether it is this row at this site.
    #[cfg(test)]
    pub(super) fn is(&self, row: Row, site: Site) -> bool {
        self.row == row && self.site == site
    }
}

/// A term that was tried.
#[derive(Debug, Clone)]
pub(super) struct Screened {
    /// Where it enters.
    pub site: Site,
    /// The term with its best numbers.
    pub sized: Sized,
    /// Growth of the log-likelihood with this term, less a penalty for its parameters and the size of the search.
    pub evidence: f64,
    /// Its column in the regression.
    pub column: Column,
}

impl Screened {
    /// Whether it is this term with these shapes and any coefficient.
    pub fn is(&self, sized: &Sized) -> bool {
        self.sized.term == sized.term && self.sized.shapes == sized.shapes && self.sized.cylinder == sized.cylinder
    }
}

/// Result of trying all terms at all places of a machine, the best first.
pub(super) struct Screening {
    /// The rows of the regression.
    pub projection: Projection,
    /// The best terms.
    pub best: Vec<Screened>,
}

/// Number of terms that are kept.
const KEPT: usize = 480;

/// Number of shape choices of a term that are kept for each sign: noise in the equations may favour a wrong one.
const KEPT_SHAPES: usize = 3;

/// Tries all terms on the residual of `model`.
///
/// # Errors
/// [`RegressionError`] if a recording lacks inputs.
pub(super) fn screen(
    model: &Model,
    identification: &[&Recording],
    validation: &[&Recording],
) -> Result<Screening, RegressionError> {
    let (probed, probes, entries) = probed(model);
    let settings = WeakFormSettings::default();
    let fitted = weak_terms(&probed, probes, identification, &settings)?;
    let predicted = weak_terms(&probed, probes, validation, &settings)?;
    let projection = Projection::new(&fitted, &predicted);
    let tries = tries(&entries, &fitted);
    let cost_of_parameter = 0.5 * projection.independent().max(1.0).ln();
    let cost_of_search = (tries.len().max(1) as f64).ln();
    let column = |entry: Entry, law: &Evaluated| {
        projection.column(
            &fitted.regressor(entry.probe, &law.values(&fitted))?,
            &predicted.regressor(entry.probe, &law.values(&predicted))?,
        )
    };
    // Columns are not kept here: those of all terms would fill the memory.
    let mut tried: Vec<(Entry, Sized, f64)> = tries
        .par_iter()
        .filter_map(|(entry, term, shapes)| {
            let law = Evaluated::new(&probed, *entry, *term, shapes)?;
            let column = column(*entry, &law)?;
            let (coefficient, gain) = projection.gain(&column).filter(|(own, _)| *own >= 0.0 || !term.is_whole())?;
            let evidence = gain - cost_of_parameter * term.parameters() as f64 - cost_of_search;
            Some((*entry, Sized { coefficient, ..law.sized }, evidence))
        })
        .collect();
    tried.sort_by(|a, b| b.2.total_cmp(&a.2));
    let mut kept: Vec<(Entry, Sized, f64)> = Vec::new();
    for one in tried {
        let is_same = |other: &&(Entry, Sized, f64)| other.0.site == one.0.site && other.1.is_same_kind(&one.1);
        if kept.len() < KEPT && kept.iter().filter(is_same).count() < KEPT_SHAPES {
            kept.push(one);
        }
    }
    let best = kept.into_par_iter().filter_map(|(entry, sized, evidence)| {
        let column = column(entry, &Evaluated::new(&probed, entry, sized.term, &sized.shapes)?)?;
        Some(Screened { site: entry.site, sized, evidence, column })
    });
    let best = best.collect();
    Ok(Screening { projection, best })
}

/// The model with a probe in every row at every site.
pub(super) fn probed(model: &Model) -> (Model, usize, Vec<Entry>) {
    let (mut probed, mut probes, mut entries) = (model.clone(), 0, Vec::new());
    for card in ROWS.iter().filter(|card| !card.row.is_a_reading()) {
        let Some(probe) = probe(card.row) else { continue };
        for site in model.free_sites(&probe) {
            if let Ok(more) = probed.with_effect(&probe, site) {
                probed = more;
                let probe = probes;
                probes += 1;
                let cylinders = match site {
                    Site::Cylinder(cylinder) => cylinder..cylinder + 1,
                    Site::PumpLine | Site::Machine => 0..model.machine.cylinders.len(),
                };
                entries.extend(cylinders.map(|cylinder| Entry { row: card.row, site, probe, cylinder }));
            }
        }
    }
    (probed, probes, entries)
}

/// An effect that adds its parameter to a row.
fn probe(row: Row) -> Option<AnyEffect> {
    let term = Term::of(row, &ONE);
    let mut text = law_text(&[Sized { term, shapes: Vec::new(), coefficient: 1.0, cylinder: String::new() }], "")?;
    text.name = format!("probe_{}", row.card().name);
    let parameter = text.parameters.get_mut("k")?;
    (parameter.minimum, parameter.maximum, parameter.start) = (Some(-1.0), Some(1.0), vec![0.0]);
    Some(Arc::new(Law::read(&text).ok()?))
}

/// Every term at every place, with all start values of its shapes.
fn tries(entries: &[Entry], terms_of: &WeakTerms<'_>) -> Vec<(Entry, Term, Vec<f64>)> {
    let terms = terms();
    let mut tries = Vec::new();
    for entry in entries {
        // A term without a cylinder in its formula is tried once.
        let is_first =
            |term: &&Term| term.names_a_cylinder() || matches!(entry.site, Site::Cylinder(_)) || entry.cylinder == 0;
        for term in terms.iter().filter(|term| term.row == entry.row).filter(is_first) {
            let shapes = term.factors.iter().flat_map(|factor| factor.shapes);
            let mut grid: Vec<Vec<f64>> = vec![Vec::new()];
            for shape in shapes {
                let mut starts = shape.quantity.starts(shape.levels, &terms_of.situations, entry.cylinder);
                starts.retain(|start| shape.is_signed || *start > 0.0);
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
pub(super) struct Evaluated {
    law: Law,
    entry: Entry,
    sized: Sized,
    parameters: Vec<f64>,
}

impl Evaluated {
    pub(super) fn new(model: &Model, entry: Entry, term: Term, shapes: &[f64]) -> Option<Evaluated> {
        let cylinder = model.machine.cylinders.get(entry.cylinder).map_or(String::new(), |one| one.name.clone());
        let sized = Sized { term, shapes: shapes.to_vec(), coefficient: 1.0, cylinder };
        let text = law_text(std::slice::from_ref(&sized), "")?;
        let law = Law::read(&text).ok()?;
        let cards = law.parameters(&model.machine, entry.site);
        let mut left = shapes.iter();
        let names: Vec<&str> = term.factors.iter().flat_map(|factor| factor.shapes).map(|shape| shape.name).collect();
        let values: Vec<(&str, f64)> = names.into_iter().map(|name| (name, *left.next().unwrap_or(&0.0))).collect();
        let value = |name: &str| values.iter().find(|(known, _)| *known == name).map_or(1.0, |(_, value)| *value);
        let parameters = cards.iter().map(|card| value(&card.name)).collect();
        Some(Evaluated { law, entry, sized, parameters })
    }

    /// Its values, by recording and by sample.
    pub(super) fn values(&self, terms: &WeakTerms<'_>) -> Vec<Vec<f64>> {
        let of_recording = |situations: &Vec<Situation<'_, f64>>| {
            let states = self.states(situations);
            let value = |(sample, now): (usize, &Situation<'_, f64>)| {
                let own = states.get(sample).map_or(&[][..], Vec::as_slice);
                change(&self.law, self.entry.site, &self.parameters, own, now)
            };
            situations.iter().enumerate().map(value).collect()
        };
        terms.situations.iter().map(of_recording).collect()
    }

    /// States of a law with memory along a recording; empty for a law without memory.
    fn states(&self, situations: &[Situation<'_, f64>]) -> Vec<Vec<f64>> {
        memory_along(&self.law, self.entry.site, &self.parameters, situations)
    }
}
