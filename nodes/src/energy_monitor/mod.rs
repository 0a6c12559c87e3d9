//! The energy balance of the machine, state by state.

mod convert;
mod incoming;
mod ledger;
mod node;

pub use node::{parameters, run};
