//! What is printed: sentences, tables, charts and progress, wrapped to the terminal and safe for it.

mod chart;
mod paragraph;
mod printing;
mod progress;
mod tables;
mod text;
mod verbosity;

pub use chart::chart;
pub use paragraph::{command, filled};
pub use printing::{all_was_printed, print, print_detail, print_fitted, print_text};
pub use progress::Progress;
pub use tables::{
    Stage, candidate_table, change_table, characterisation_table, comparison_table, correlation_table, effect_table,
    energy_table, ledger_table, not_in_mean, opening_table, pair_table, parameter_table, phase_table, proposal_table,
    refusals, remedy_lines, right, stage_table, table,
};
pub use text::{complain, printable, remark, text, width};
pub use verbosity::Verbosity;
