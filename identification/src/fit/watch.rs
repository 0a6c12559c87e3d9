//! Callback that follows a long computation and can stop it.

use std::ops::ControlFlow;

/// Called with the fraction done (0 to 1) before each round of a computation. Its return value decides whether to
/// continue. A round simulates the recordings once or twice: a few tenths of a second per minute of recording.
pub type Watch<'w> = &'w dyn Fn(f64) -> ControlFlow<()>;
