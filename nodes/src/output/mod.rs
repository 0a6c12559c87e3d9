//! What people and programs see of results.

mod json;
mod progress;
mod tables;

pub use json::{comparison_json, diagnosis_json, identification_json, refinement_json, write_json};
pub use progress::Progress;
pub use tables::{candidate_table, comparison_table, number, parameter_table, step_table};
