//! `excavator node identification`: the action `/identification/run`.
//!
//! Whoever is on the network may send a goal. So a goal names models and bags below folders that the operator gave, and
//! nothing else on the machine; goals are bounded in number, size and time; and a result becomes the model in use only where
//! the operator said so.

mod desk;
mod goals;
mod library;
mod node;
mod printable;
mod queue;
mod refusals;
mod server;
mod types;
mod work;

pub(crate) use node::parameters;
pub use node::run;
