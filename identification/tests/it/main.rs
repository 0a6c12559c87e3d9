//! The integration tests of this crate, in one binary: each links the crate anew.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, missing_docs)]

mod coarse_recordings;
mod common;
mod contact_and_another;
mod effects_in_pictures;
mod named_additions;
mod picked_up;
mod profile_likelihood;
mod rounded_corners;
mod similar_machines;
mod spool_sensor_lead;
mod story_of_the_excavator;
mod three_joints;
mod together_only;
mod two_joints;
