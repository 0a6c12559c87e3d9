//! `excavator play`: a bag onto the graph, in its own rhythm.

mod commands;
mod keys;
mod node;
mod schedule;

pub use node::run;
