//! Shows where something is missing and what it depends on, from the predictions for single terms.

use std::collections::BTreeMap;

use excavator_model::{Model, site_name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::promise::Promised;
use crate::nullable::Nullable;

/// A row of the equations or a variable, by what single terms promise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Finding {
    /// `piston_force@arm`, or a variable as formulas write it: `v`.
    pub name: String,
    /// Share, 0 to 1.
    #[serde(with = "Nullable")]
    pub share: f64,
}

/// Summary of the predictions for single terms.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Survey {
    /// Rows, the most promising first. Shares are relative to the best term of all.
    pub rows: Vec<Finding>,
    /// Variables, the most needed first.
    pub variables: Vec<Finding>,
}

/// Smallest share that is listed.
const LEAST: f64 = 0.02;

/// Names of variables in formulas.
const VARIABLES: [&str; 8] = ["v", "s", "p_cap", "p_rod", "p_pump", "u", "t", "z"];

impl Survey {
    /// Summarises the predictions for single terms, which are sorted best first.
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
