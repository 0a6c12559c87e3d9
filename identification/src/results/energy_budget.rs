//! One sum of the energies of a recording.

use excavator_model::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::energy::{BudgetShare, EnergyAnalysis};

/// Where the delivered energy went: `delivered = sum of lines`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct EnergyBudget {
    /// Delivered by the pump, or where the model has none by the supply or by the force on the rods, J.
    pub delivered: Option<f64>,
    /// Losses, stores, and last what is not explained.
    pub lines: Vec<EnergyBudgetLine>,
    /// What noise of sensors, uncertainty of parameters and smoothing can leave unexplained, J.
    pub explicable: Option<f64>,
    /// Whether what is not explained is within that.
    pub is_within_noise: bool,
}

/// A part of the delivered energy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct EnergyBudgetLine {
    /// What became of it.
    pub share: BudgetShare,
    /// The effect or the store.
    pub what: String,
    /// Name of its place: a cylinder, `pump` or `machine`.
    pub place: String,
    /// Energy, J.
    pub energy: Option<f64>,
}

impl EnergyBudget {
    /// Of an analysis.
    pub(super) fn of(model: &Model, analysis: &EnergyAnalysis) -> Self {
        let budget = analysis.budget(model);
        let line = |one: &crate::energy::BudgetLine| EnergyBudgetLine {
            share: one.share,
            what: one.what.clone(),
            place: one.place.clone(),
            energy: finite(one.energy),
        };
        EnergyBudget {
            delivered: finite(budget.delivered),
            lines: budget.lines.iter().map(line).collect(),
            explicable: finite(analysis.explicable()),
            is_within_noise: analysis.is_within_noise(&budget),
        }
    }
}
