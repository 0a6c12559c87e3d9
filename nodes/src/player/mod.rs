//! Publishes a bag on the graph with its original timing.

mod commands;
mod keys;
mod node;
mod schedule;

pub use node::{PlayOptions, run};
