//! `excavator node arm-simulator`: a model as a machine on the graph.

mod declared;
mod node;
mod plant;
mod sensors;
mod stamps;

pub use node::run;
