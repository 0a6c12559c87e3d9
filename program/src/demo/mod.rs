//! `excavator demo`: the whole workflow on a machine with a hidden effect.

pub mod manoeuvre;
pub mod plant;
pub mod sealed;
mod story;

pub(crate) use story::run;
