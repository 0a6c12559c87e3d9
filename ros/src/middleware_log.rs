//! Counts warnings and errors of the middleware. It logs them and goes on, and nobody reads its log.

use std::sync::atomic::{AtomicU64, Ordering};

use log::{Level, LevelFilter, Log, Metadata, Record};

/// Log target of the packet parser. Its warnings are about malformed packets.
const RECEIVER: &str = "rustdds::rtps::message_receiver";

static COUNTER: Counter = Counter { malformed: AtomicU64::new(0), others: AtomicU64::new(0) };

struct Counter {
    malformed: AtomicU64,
    others: AtomicU64,
}

impl Log for Counter {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.level() <= Level::Warn
    }

    /// Counts the record and drops it: a flood of malformed packets must not fill the log.
    fn log(&self, record: &Record<'_>) {
        if self.enabled(record.metadata()) {
            let counter = if record.target() == RECEIVER { &self.malformed } else { &self.others };
            counter.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn flush(&self) {}
}

/// Counts from now on. If the program already has a logger, that logger stays and nothing is counted.
pub(super) fn count_complaints() {
    if log::set_logger(&COUNTER).is_ok() {
        log::set_max_level(LevelFilter::Warn);
    }
}

/// Number of malformed packets, and of other warnings and errors of the middleware, since the start.
pub(super) fn complaints() -> (u64, u64) {
    (COUNTER.malformed.load(Ordering::Relaxed), COUNTER.others.load(Ordering::Relaxed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complaints_are_counted_by_their_origin() {
        let counter = Counter { malformed: AtomicU64::new(0), others: AtomicU64::new(0) };
        for (target, level) in [
            (RECEIVER, Level::Warn),
            (RECEIVER, Level::Error),
            (RECEIVER, Level::Debug),
            ("rustdds::discovery", Level::Warn),
        ] {
            counter.log(&Record::builder().target(target).level(level).build());
        }
        assert_eq!((counter.malformed.into_inner(), counter.others.into_inner()), (2, 1));
    }
}
