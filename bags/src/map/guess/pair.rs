//! A candidate with one signal that it may be.

use super::super::signal::SignalKind;

/// A candidate, a possible signal for it, and a score.
pub(super) struct Pair {
    pub candidate: usize,
    pub kind: SignalKind,
    pub score: f64,
    pub reason: String,
    /// Whether only order, size or motion support it.
    pub is_weak: bool,
}
