//! Where something is missing and what it depends on, by what single terms promise.

use std::collections::BTreeMap;

use excavator_model::{Model, site_name};

use super::promise::Promised;

/// A row of the equations, or a variable, with the share of the error that terms there, or with it, would take away.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// `piston_force@arm`, or `v`.
    pub name: String,
    /// Of a row: the fall of the loss that its best term promises. Of a variable: the part of the fall that the best term without it does
    /// not bring, as a share of the best.
    pub share: f64,
}

/// What single terms promise, put together.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Survey {
    /// Rows, the one whose best term promises most first; as shares of that.
    pub rows: Vec<Finding>,
    /// Variables, the one that is needed most first.
    pub variables: Vec<Finding>,
}

/// Least share that is worth a line.
const LEAST: f64 = 0.02;

/// Variables as formulas write them, with what people call them.
const VARIABLES: [&str; 8] = ["v", "s", "p_cap", "p_rod", "p_pump", "u", "t", "z"];

impl Survey {
    /// Of the promises of single terms, the best first.
    pub(super) fn of(model: &Model, foretold: &[Promised]) -> Survey {
        let Some(best) = foretold.first().map(|one| one.improvement).filter(|best| *best > 0.0) else {
            return Survey::default();
        };
        let mut rows: BTreeMap<String, f64> = BTreeMap::new();
        for one in foretold {
            let Some(term) = one.candidate.terms.first() else { continue };
            let place = site_name(&model.machine, one.candidate.site);
            let row = rows.entry(format!("{}@{place}", term.term.row.card().name)).or_insert(0.0);
            *row = row.max(one.improvement / best);
        }
        let needed = |variable: &str| {
            let without = foretold.iter().find(|one| !one.candidate.terms.iter().any(|term| term.term.uses(variable)));
            1.0 - without.map_or(0.0, |one| (one.improvement / best).max(0.0))
        };
        let variables = VARIABLES.iter().map(|variable| (variable.to_string(), needed(variable)));
        Survey { rows: sorted(rows.into_iter()), variables: sorted(variables) }
    }
}

fn sorted(findings: impl Iterator<Item = (String, f64)>) -> Vec<Finding> {
    let mut sorted: Vec<Finding> =
        findings.map(|(name, share)| Finding { name, share }).filter(|one| one.share >= LEAST).collect();
    sorted.sort_by(|a, b| b.share.total_cmp(&a.share));
    sorted
}
