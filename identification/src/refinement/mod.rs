//! Adds effects to a model step by step, with a refit and a comparison after each.

mod refine;

pub use refine::{Additions, Reason, RefineError, Refinement, Step, refine, refinement_of};
