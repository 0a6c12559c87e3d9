//! The command gate: every command to a valve passes through it.
//!
//! A command is followed if it passes all of these checks, in this order:
//!
//! 1. its writer may command ([`writer`]),
//! 2. its stamp is neither too old nor in the future ([`stamp`]),
//! 3. names and areas are valid and within the limits of the valves ([`content`]),
//! 4. the gate is active and the machine is not stopped ([`stop`]),
//! 5. none of the valves that it names has another owner of the same or a higher priority ([`gate`]),
//! 6. for a valve that was closed for safety, it commands an area of 0 first ([`gate`]).
//!
//! A refused command changes nothing; no command is followed in part. An accepted one renews its writer's lease on every valve
//! that the writer owns. When a lease expires, its valve closes by a ramp, and so do all valves on a stop. The rate of each
//! opening is limited on the way to the valve ([`slew`]).
//!
//! Everything here depends only on its arguments, including the time. Only [`desk`] uses ROS.

mod content;
mod desk;
mod gate;
mod parameters;
mod refusal;
mod report;
mod slew;
mod source;
mod stamp;
mod stop;
mod words;
mod writer;

pub(crate) use content::Valve;
pub(crate) use desk::Desk;
pub(crate) use parameters::parameters;
pub(crate) use slew::{Slew, Wanted};
#[cfg(feature = "dashboard")]
pub(crate) use words::{CLOSED_BECAUSE, COMMAND_AGE, COMMANDED_BY, STOPPED_BY};
