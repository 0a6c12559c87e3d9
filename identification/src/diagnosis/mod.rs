//! Which physical effect is missing: candidates, evidence, verdict.

mod adequacy;
mod both_sides;
mod candidate;
mod chain;
mod construction;
mod contribution;
mod diagnose;
mod evidence;
mod hard_stretches;
mod inclusion;
mod input_floor;
mod named;
mod own_windows;
mod race;
mod residual_map;
mod residual_points;
mod settings;
mod settle;
mod starts;
mod track;
mod worst_stretch;

use adequacy::adequacy;
pub use adequacy::{Adequacy, normalised_error};
pub use candidate::{Candidate, CandidateError, Unpromising, additions};
pub(crate) use candidate::{addition_with_effects_along, fit_addition};
pub use contribution::{Contribution, ContributionBin, contribution};
pub(crate) use diagnose::fit_nominal;
pub use diagnose::{Diagnosis, DiagnosisError, Verdict, diagnose};
pub use evidence::{Evidence, compare_losses};
pub use inclusion::Inclusion;
pub use named::NamedVerdict;
pub(crate) use named::judge_named;
pub use residual_map::{Share, Unexplained, residual_map, unexplained};
pub use settings::DiagnosisSettings;
