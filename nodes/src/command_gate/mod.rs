//! The command gate: the one place that every command to a valve passes.
//!
//! A command is followed when all of this holds, in this order:
//!
//! 1. its writer is allowed to command ([`writer`]),
//! 2. its stamp is neither too old nor in the future ([`stamp`]),
//! 3. names and areas are sound and within the limits of the valves ([`content`]),
//! 4. nobody has stopped the machine ([`stop`]),
//! 5. nobody else owns one of the valves that it names, except with a lower priority ([`gate`]),
//! 6. a valve that was closed for safety is asked to stay closed first ([`gate`]).
//!
//! A refused command changes nothing: half of a command is none. An accepted one renews its writer's lease on every valve
//! that the writer owns. A lease that runs out closes its valve by a ramp, and so does a stop. On the way to the valve each
//! opening is limited in its rate ([`slew`]).
//!
//! Everything in here is a function of the arguments, with time handed in; [`desk`] alone knows ROS.

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
pub(crate) use words::{CLOSED_BECAUSE, COMMAND_AGE, COMMANDED_BY, STOPPED_BY};
