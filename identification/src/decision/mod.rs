//! Derives a verdict with its reasons from the scores of a search. Pure functions; no model is fitted here.

mod adequacy;
mod assessment;
mod confidence_set;
mod decide;
#[cfg(test)]
mod made_scores;
mod policy;
mod presence;
mod resampling;
pub mod scores;
pub mod statistic;
#[cfg(test)]
mod tests;
mod verdict;

pub use decide::{decide, leaves_nothing};
pub use policy::Policy;
pub use presence::presence;
pub use resampling::improvement_on_blocks;
pub use scores::{Hypothesis, Scores, ScoresError};
pub use statistic::{block_cost, block_costs_of, log_error_ratio, relative_error};
pub use verdict::{Differing, Kind, Reason, Standing, Verdict};
