//! Add an effect, refit, measure again, stop.

mod refine;

pub use refine::{Additions, Reason, RefineError, Refinement, Step, refine, refinement_of};
