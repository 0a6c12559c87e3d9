//! The integration tests of this crate, in one binary: each links the crate anew.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, missing_docs)]

mod announced_hooks;
mod common;
mod documents;
mod effect_cards;
mod effect_faces;
mod energy_balance;
mod energy_monitor;
mod formulas;
mod formulas_at_work;
mod hard_situations;
mod imposed_motion;
mod instruments;
mod linkage;
mod long_steps;
mod mechanical_effects;
mod planar_chain;
mod reference_solutions;
mod sensitivities;
mod signals;
mod similarity;
mod temperature_laws;
mod valve_effects;
