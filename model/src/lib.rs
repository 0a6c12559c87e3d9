//! What a hydraulic arm is and does: machines, physical effects, simulation and energy.
//!
//! The one idea: **a [`Model`] is a [`machine::Machine`] plus a list of physical effects.** One effect is one file in
//! [`effects`], written once for any [`scalar::Scalar`], and everything else is derived from it: what it adds in
//! simulation, its regressor, its power in the energy balance, and how it shows in data.
//!
//! Equations are those of \[A\] Arai, Sakai, Tatsuoka, Zhang, Energies 14 (2021) 6210 and \[B\] "Accurate Dynamic Modelling
//! of Hydraulic Servomechanisms"; `docs/physics.md` lists where the code departs from print, and why. SI units
//! everywhere, pressures are gauge. This crate reads no files, knows no ROS and does no statistics.

pub mod check;
pub mod display;
pub mod document;
pub mod effects;
pub mod energy;
pub mod equations;
mod errors;
pub mod formula;
pub mod machine;
mod model;
pub mod prelude;
pub mod recording;
pub mod scalar;
pub mod simulation;
pub mod template;
mod urdf;

pub use errors::{ModelError, SignalError};
pub use model::{HistoryEntry, Model, ModelEffect, Parameter, addition_name, site_name, site_named};
pub use urdf::urdf;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
