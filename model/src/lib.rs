//! Models of hydraulic machines: geometry, physical effects, simulation and energy.
//!
//! The one idea: **a [`Model`] is a [`machine::Machine`] plus a list of physical effects.** Each effect is one file in
//! [`effects`], written once for any [`scalar::Scalar`]. Everything else is derived from it: its contribution to the
//! simulation, its regressor, its power in the energy balance, and its signature in data.
//!
//! Equations are those of \[A\] Arai, Sakai, Tatsuoka, Zhang, Energies 14 (2021) 6210 and \[B\] "Accurate Dynamic Modelling
//! of Hydraulic Servomechanisms"; `docs/physics.md` lists where the code departs from print, and why. Units are SI, and
//! pressures are gauge. This crate reads no files, does not depend on ROS and does no statistics.

pub mod check;
pub mod display;
pub mod document;
pub mod effects;
pub mod energy;
pub mod equations;
mod errors;
pub mod formula;
mod limits;
pub mod machine;
mod model;
pub mod prelude;
pub mod recording;
pub mod scalar;
pub mod simulation;
pub mod template;
mod urdf;

pub use errors::{ModelError, SignalError};
pub use model::{HistoryEntry, Imposed, Model, ModelEffect, Parameter, addition_name, site_name, site_named};
pub use urdf::urdf;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
