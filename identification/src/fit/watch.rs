//! A long computation that can be followed, and ended from outside.

use std::ops::ControlFlow;

/// Told the fraction done (0 to 1) before each round of a computation; says whether to go on. A round simulates the
/// recordings once or twice: a few tenths of a second per minute of recording.
pub type Watch<'w> = &'w dyn Fn(f64) -> ControlFlow<()>;
