//! Counts CAN frames that were not used.

use std::sync::atomic::AtomicU64;

/// Counts of unused frames.
#[derive(Debug, Default)]
pub(super) struct Counts {
    /// Frames of a wanted message that are shorter than its signals need.
    pub short: AtomicU64,
    /// Frames of a second sender of a wanted message.
    pub others: AtomicU64,
    /// Error and remote frames.
    pub without_data: AtomicU64,
    /// Lines of a log that are not frames.
    pub unreadable: AtomicU64,
}
