//! How many CAN frames were of no use.

use std::sync::atomic::AtomicU64;

/// What frames were not used.
#[derive(Debug, Default)]
pub(super) struct Counts {
    /// Frames of a wanted message that are shorter than its signals need.
    pub short: AtomicU64,
    /// Error and remote frames.
    pub without_data: AtomicU64,
    /// Lines of a log that are no frame.
    pub unreadable: AtomicU64,
}
