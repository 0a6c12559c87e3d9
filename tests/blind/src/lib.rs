//! The blind benchmark: a second simulator, written from the equations of \[A\] alone, hides a physical effect in an arm;
//! the diagnosis sees only the recordings and is scored.
//!
//! Nothing here uses the model crate's equations, effects or integrator: a mistake made there would otherwise be made
//! twice and cancel. Only its `Recording` is used, as the container of what the instruments saw.
//!
//! A case goes one way: [`cases`] draws it, [`strength`] sizes the effect, [`run`] moves the [`plant`] through the
//! [`manoeuvres`], [`instruments`] record it, [`scoring`] asks the diagnosis, [`answer`] compares, [`table`] prints; [`replay`] judges
//! stored scores again.

pub mod answer;
pub mod cases;
pub mod instruments;
pub mod laws;
pub mod manoeuvres;
pub mod plant;
pub mod reliability;
pub mod replay;
pub mod run;
pub mod scoring;
pub mod storing;
pub mod strength;
pub mod table;
