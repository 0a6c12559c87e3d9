//! The action `/identification/run`.
//!
//! Anyone on the network may send a goal. So a goal can name only models and bags below folders that the operator has set.
//! Goals are bounded in number, size and time. A result becomes the model in use only if the operator has enabled that.

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

pub use node::{parameters, run};
