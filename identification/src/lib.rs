//! Compares a model with recordings: identifies its parameters, measures its misfit, finds where it fails and which
//! physical effect is missing.
//!
//! Data flows one way: recording -> regression -> model -> simulation -> hypotheses -> scores -> verdict ->
//! refinement. This crate reads no files and does not depend on ROS; `excavator-report` writes the pages with its results.

pub mod change;
pub mod characterisation;
pub mod checks;
pub mod decision;
pub mod design;
pub mod diagnosis;
pub mod energy;
pub mod fit;
pub mod identify;
mod nullable;
pub mod plausibility;
pub mod positioner;
pub mod prelude;
pub mod proposal;
pub mod refinement;
pub mod regression;
pub mod results;
pub mod search;
pub mod selection;
pub mod validation;
pub mod value_marks;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
