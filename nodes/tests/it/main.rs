//! The integration tests of this crate that need no program: what a node offers beside the graph.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, missing_docs)]

#[cfg(feature = "dashboard")]
mod dashboard_server;

/// The longest time that any test waits for something.
#[cfg(feature = "dashboard")]
const LONGEST_WAIT: std::time::Duration = std::time::Duration::from_secs(90);
