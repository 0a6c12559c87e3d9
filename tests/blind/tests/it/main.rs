//! The integration tests of this crate, in one binary: each links the crate anew.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, missing_docs)]

mod against_model;
mod full;
mod instruments_record;
mod plant_at_rest;
mod plant_energy;
mod scores;
mod stored_scores;
