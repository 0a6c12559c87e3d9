//! The integration tests of this crate, in one binary: each links the crate anew.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, missing_docs)]

mod bad_input;
mod benches;
mod characterise;
mod common;
mod compare_others;
mod energy;
mod full;
#[cfg(all(feature = "dashboard", feature = "can", feature = "tables"))]
#[path = "../../../tests/hostile/mod.rs"]
mod hostile;
mod import;
#[cfg(all(feature = "dashboard", feature = "can"))]
mod live;
mod model_file;
mod monte_carlo;
mod odd_recordings;
mod own_physics;
mod practice;
mod refinement;
mod results;
mod servo_bench;
mod start;
mod story;
