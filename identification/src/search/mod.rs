//! Proposes hypotheses: the given model with some effects added, each fitted and scored. It makes no decision.

mod addition;
mod balances;
mod both_sides;
mod effort;
mod given;
mod hard_stretches;
mod input_floor;
mod joining;
mod named;
mod pool;
mod progress;
mod promises;
mod scoring;
mod screening;
#[expect(clippy::module_inception, reason = "the folder is named after what it does, the file after its function")]
mod search;
mod starts;
mod stepwise;
mod track;
mod transient;
mod trial;
mod try_laws;
mod worst_stretch;

pub(crate) use addition::fit_addition;
pub use addition::{Addition, AdditionError, additions};
pub use effort::Effort;
pub(crate) use given::fit_given;
pub(crate) use named::score_named;
pub use pool::{Pool, Unpromising};
pub use scoring::{begin as scores_of_given, score};
pub(crate) use scoring::{misfit, side};
pub use search::search;
pub use trial::Trial;
pub(crate) use try_laws::{try_each_alone, try_laws};
