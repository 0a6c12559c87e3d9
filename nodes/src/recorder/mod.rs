//! Records topics of any type into a bag.

mod losses;
mod node;
mod offered;
mod selection;
mod writing;

pub use node::{RecordingOptions, run};
