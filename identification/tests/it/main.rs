//! The integration tests of this crate, in one binary: each links the crate anew.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, missing_docs)]

mod common;
mod contact_and_another;
mod drift;
mod effects_in_pictures;
mod energies_of_effects;
mod full;
mod named_additions;
mod printed_least_squares;
mod profile_likelihood;
mod rounded_corners;
mod several_effects;
mod spool_sensor_lead;
mod story_of_the_excavator;
mod swapped_pressures;
mod together_only;
mod two_joints;
