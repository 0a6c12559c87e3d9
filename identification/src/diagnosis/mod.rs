//! Finds the missing physical effect: a search, the verdict on its scores, and where the model fails.

mod candidates;
mod confirmed;
mod contribution;
mod diagnose;
mod named;
mod record;
mod remainder;
mod residual_map;
mod residual_points;

pub use candidates::{Candidate, Part};
pub(crate) use confirmed::confirmed;
pub use contribution::{Contribution, ContributionBin, Drawn, contribution};
pub(crate) use diagnose::diagnosis_of;
pub use diagnose::{Diagnosis, DiagnosisError, DiagnosisSettings, diagnose};
pub use named::NamedVerdict;
pub(crate) use named::judge_named;
pub use record::{DiagnosisRecord, RecordError};
pub use remainder::Remainder;
pub use residual_map::{Share, Unexplained, unexplained};
