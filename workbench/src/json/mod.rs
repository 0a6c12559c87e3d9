//! The JSON of results, as `--json` writes it.

mod characterisation;
mod design;
mod energy;
mod fits;
mod identified;
mod proposals;

pub use characterisation::characterisation_json;
pub use design::{determination_json, separation_json};
pub use energy::{energy_json, missing_power_json};
pub use fits::{comparison_json, diagnosis_json, finite, refinement_json};
pub use identified::identified_json;
pub use proposals::{guess_json, proposal_json};
