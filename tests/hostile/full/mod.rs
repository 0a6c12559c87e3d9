//! Faults that take seconds, most of them on networks of their own: `tests/run --all` tries them.

mod bridge;
mod faces;
mod goals;
#[cfg(feature = "security")]
mod keystore;
mod monitor;
mod network;
mod recorder;
#[cfg(feature = "security")]
mod security;
mod silence;
