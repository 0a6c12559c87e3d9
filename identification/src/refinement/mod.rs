//! Add an effect, refit, measure again, stop.

mod refine;

pub use refine::{Additions, RefineError, Refinement, Step, refine};
