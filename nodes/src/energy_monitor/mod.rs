//! `excavator node energy-monitor`: the energy balance of the machine, state by state.

mod convert;
mod incoming;
mod ledger;
mod node;

pub(crate) use node::parameters;
pub use node::run;
