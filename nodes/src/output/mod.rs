//! What people and programs see of results.

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

pub use characterisation::{characterisation_json, characterisation_table, refusals};
pub use chart::chart;
pub use design::{determination_json, pair_table, separation_json};
pub use energy::{energy_json, energy_table, ledger_table, missing_power_json};
pub use json::{comparison_json, diagnosis_json, finite, identification_json, refinement_json, write_json};
pub use next_step::NextStep;
pub use paragraph::filled;
pub use progress::Progress;
pub use proposals::{guess_json, proposal_json, proposal_table};
pub use tables::{
    Stage, candidate_table, compared_steps, comparison_table, correlation_table, effect_table, number, parameter_table,
    phase_table, remedy_lines, right, stage_table, table,
};
