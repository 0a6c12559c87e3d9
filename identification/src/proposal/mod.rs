//! From a curve to a law: formulas for physics that no catalogue has.
//!
//! Where nothing in the catalogue explains what a model leaves, terms of a grammar are tried on the equations (`screening`), put together
//! (`shortlist`), fitted like effects of the catalogue, and judged by the same decision. Where no law holds, the curve itself is one
//! (`curve`), and says so.

mod bounded;
mod curve;
mod grammar;
mod guess;
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
