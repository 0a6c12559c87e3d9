//! The energy balance of a working machine, sample by sample, from measurements.
//!
//! Each state gets one [`Balance`], with the same effect code that drives the simulation. Two of its numbers need a
//! derivative: the velocity, if no sensor measures it, and the rate of the Hamiltonian. Both are the slope of the
//! least-squares parabola over the samples within `half_width` of the state. So a balance belongs to a past state and
//! carries that state's timestamp: the delay is one half width, or two if the velocity is estimated
//! ([`Monitor::delay`]).

mod balance;
mod pipeline;
mod slope;
mod watch;

pub use balance::{Balance, CylinderBalance, EffectTerm};
pub use pipeline::{Counts, Monitor, Settings};
pub use watch::{Watch, WatchSettings, Window};
