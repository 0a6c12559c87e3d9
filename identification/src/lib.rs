//! What a recording says about a model: which parameters it has, how far it is from the measurement, where it fails, and
//! which physical effect it is missing.
//!
//! Data flows one way: recording -> regression -> model -> simulation -> hypotheses -> scores -> verdict ->
//! refinement. This crate reads no files and knows no ROS; the pages with its results are those of `excavator-report`.

pub mod characterisation;
pub mod checks;
pub mod decision;
pub mod design;
pub mod diagnosis;
pub mod energy;
pub mod fit;
pub mod identify;
pub mod plausibility;
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
