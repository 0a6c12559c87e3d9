//! Tests that `tests/run --all` runs: whole searches.

mod effects_show;
mod near_twins;
