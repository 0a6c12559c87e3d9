//! Proposes formulas for physics that is missing in every catalogue.
//!
//! If nothing in the catalogue explains the residual of a model, terms of a grammar are tried on the equations
//! (`screening`) and combined (`shortlist`). The resulting laws are fitted like effects of the catalogue, and judged by
//! the same decision. If no law holds, the curve itself is proposed as one (`curve`), and is labelled as a curve.

mod bounded;
mod curve;
mod grammar;
mod guess;
mod law_candidate;
mod memory;
mod merits;
mod projection;
mod promise;
mod proposals;
mod propose;
mod remarks;
mod screening;
mod shortlist;
mod simplest;
mod survey;
#[cfg(test)]
mod tests;

pub use guess::{Guess, first_guess, guess_for};
pub use merits::Merits;
pub use proposals::{Proposal, ProposalVerdict, Proposals};
pub use propose::propose;
pub use survey::{Finding, Survey};
