//! Is a model that can be read one that can be right? What a wrong unit or a slip of the pen does to it.

mod oddity;
mod oscillation;
mod trial;

pub use oddity::{Oddity, oddities};
pub use oscillation::{Oscillation, oscillations};
pub use trial::{Trial, trial};
