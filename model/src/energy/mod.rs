//! Energy: storage, supply and the power of each effect (\[A\] Eq. 9-12).
//!
//! The model is a port-Hamiltonian system. Its storage H is the kinetic and potential energy of the links plus the
//! energy of the oil in each chamber and in the pump line. Along the model's solutions
//!
//! `dH/dt = pump power + power of the rod forces + sum of the powers of all effects`
//!
//! holds exactly. Each effect's power comes from the same code that drives the simulation: torque times joint rate,
//! force times piston velocity, and flow times the oil's potential (`oil.rs`).

mod account;
mod ledger;
pub mod monitor;
mod oil;

pub use account::{Accountant, ledger};
pub use ledger::{CylinderStorage, EffectPower, Ledger};
pub use oil::OilEnergy;
