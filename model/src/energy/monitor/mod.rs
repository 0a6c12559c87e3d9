//! The energy balance of a machine at work, sample by sample, from what is measured.
//!
//! Each state gets one [`Balance`], with the same effect code that drives the simulation. Two of its numbers need a
//! derivative: the velocity, where no sensor measures it, and the rate of the Hamiltonian. Both are the slope of the
//! least-squares parabola over the samples within `half_width` of the state, so a balance belongs to a state in the
//! past and carries that state's stamp: the delay is one half width, two where the velocity is estimated
//! ([`Monitor::delay`]).

mod balance;
mod pipeline;
mod slope;
mod watch;

pub use balance::{Balance, CylinderBalance, EffectTerm};
pub use pipeline::{Counts, Monitor, Settings};
pub use watch::{Watch, WatchSettings, Window};
