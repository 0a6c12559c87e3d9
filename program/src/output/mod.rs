//! Formats results for users and for programs.

mod characterisation;
mod chart;
mod design;
mod energy;
mod json;
mod next_step;
mod paragraph;
mod progress;
mod proposals;
mod tables;

pub use characterisation::{characterisation_table, refusals};
pub use chart::chart;
pub use design::pair_table;
pub use energy::{energy_table, ledger_table};
pub use excavator_study::numbers::number;
pub use json::{finite, write_json};
pub use next_step::NextStep;
pub use paragraph::filled;
pub use progress::Progress;
pub use proposals::proposal_table;
pub use tables::{
    Stage, candidate_table, comparison_table, correlation_table, effect_table, parameter_table, phase_table,
    remedy_lines, right, stage_table, table,
};
