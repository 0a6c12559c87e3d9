//! `excavator node identification`: the action `/identification/run`.

mod goals;
mod node;
mod server;
mod types;
mod work;

pub use node::run;
