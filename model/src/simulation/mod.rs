//! Simulates a model with its inputs to a trajectory, with sensitivities if required.

mod coarse_inputs;
mod factors;
mod imposed_motion;
mod initial;
mod input_holes;
mod input_signals;
mod integrator;
mod linearisation;
mod observer;
mod plant;
mod profile;
mod rest;
mod run;
mod sensitivity;
mod servo;
mod servo_follower;
mod spool_estimate;
mod spool_memory;
mod trajectory;
mod undistorted;

pub use initial::{first_known_position, initial_state};
pub use input_holes::{InputHoles, input_holes};
pub use input_signals::{InputSignals, Interpolation};
pub use integrator::{Integrator, SimulationError, Tolerances};
pub use linearisation::Linearisation;
pub use observer::Observer;
pub use plant::Plant;
pub use profile::{Profile, ProfileError, Segment};
pub use rest::{reachable_rest_state, rest_state};
pub use run::{RunError, observed, simulate, simulate_from, simulate_from_rest};
pub use sensitivity::Sensitivity;
pub use undistorted::undistorted;
