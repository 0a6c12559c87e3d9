//! `excavator demo`: the whole story on a machine with a hidden effect.

mod manoeuvre;
mod plant;
mod sealed;
mod story;

pub use story::run;
