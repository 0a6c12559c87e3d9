//! Commands to valves: what is refused, and for how long a command holds.

mod check;
mod lease;

pub use check::{Valve, check};
pub use lease::{Lease, ramp};
