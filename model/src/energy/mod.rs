//! Energy: storage, supply and the power of each effect (\[A\] Eq. 9-12).
//!
//! The model is a port-Hamiltonian system. Its storage H is the kinetic and potential energy of the links plus what the
//! oil stores in each chamber and in the pump line. Along the model's solutions
//!
//! `dH/dt = pump power + power of the rod forces + sum of the powers of all effects`
//!
//! holds exactly, and each effect's power comes from the same lines of code that drive the simulation: torque times
//! joint rate, force times piston velocity, and flow times the oil's potential (`oil.rs`).

mod account;
mod ledger;
pub mod monitor;
mod oil;

pub use account::{Accountant, ledger};
pub use ledger::{CylinderStorage, EffectPower, Ledger};
pub use oil::OilEnergy;
