//! Says where the energy went, as one sum.

use excavator_identification::energy::{BudgetLine, BudgetShare, EnergyAnalysis};
use excavator_model::Model;
use excavator_model::machine::Supply;

use super::numbers::{percent, significant};

/// What delivers the energy.
pub fn delivered_by(model: &Model) -> &'static str {
    match model.machine.supply {
        Supply::PumpLine(_) => "pump",
        Supply::PressureSource(_) => "supply",
        Supply::None => "force on the rods",
    }
}

/// A line of the sum: `lost: metering at the arm`.
pub fn budget_label(line: &BudgetLine) -> String {
    match line.share {
        BudgetShare::Lost => format!("lost: {} at the {}", line.what, line.place),
        BudgetShare::Stored => format!("stored: {} at the {}", line.what, line.place),
        BudgetShare::Unexplained => line.what.clone(),
    }
}

/// How much of the delivered energy is not explained, and whether noise can leave as much.
pub fn budget_sentence(model: &Model, analysis: &EnergyAnalysis) -> String {
    let budget = analysis.budget(model);
    let (left, explicable) = (budget.unexplained(), analysis.explicable());
    let within = if analysis.is_within_noise(&budget) { "no more than" } else { "more than" };
    format!(
        "Of {} J from the {}, {} J ({}) are not explained: {within} the {} J that noise, uncertain parameters and smoothing can leave.",
        significant(budget.delivered, 4),
        delivered_by(model),
        significant(left, 3),
        percent(budget.share_of(left)),
        significant(explicable, 3)
    )
}
