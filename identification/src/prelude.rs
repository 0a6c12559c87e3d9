//! What most programs need, together with `excavator_model::prelude`: `use excavator_identification::prelude::*;`.
//!
//! Data goes from a regression or a fit through scores and a decision to a refinement; [`identify`](fn@identify) and
//! [`refine`](fn@refine) run the whole chain. Error types are not included, because each step has its own.

pub use crate::decision::{Kind, Policy, Scores, Verdict, decide};
pub use crate::diagnosis::{Diagnosis, DiagnosisSettings, diagnose};
pub use crate::fit::{Fit, FitSettings, fit};
pub use crate::identify::{Method, identify};
pub use crate::refinement::{Additions, Refinement, refine};
pub use crate::regression::{WeakFormSettings, weak_form};
pub use crate::validation::{Comparison, compare};
