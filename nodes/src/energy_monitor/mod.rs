//! `excavator node energy-monitor`: the energy balance of the machine, state by state.

mod convert;
mod ledger;
mod node;

pub use node::run;
