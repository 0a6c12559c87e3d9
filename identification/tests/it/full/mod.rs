//! Tests that `tests/run --all` runs: whole searches.

mod coarse_recordings;
mod picked_up;
mod similar_machines;
mod three_joints;
