//! Watches the threads of the middleware. They end silently when a system call is interrupted (SIGSTOP and SIGCONT, a
//! frozen container, suspend to disk).

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

/// Threads that the middleware starts for a participant: one for the wire, one for discovery.
const STARTED: usize = 2;

/// Time after which these threads have started: a hundred times what it takes.
const SETTLED: Duration = Duration::from_secs(1);

/// The threads of one participant.
#[derive(Debug, Clone)]
pub(super) struct Threads {
    since: Instant,
    /// Threads of others, and of abandoned participants.
    others: BTreeSet<u32>,
    own: BTreeSet<u32>,
}

/// Number of remaining threads of a participant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Died {
    pub alive: usize,
    pub started: usize,
}

impl Threads {
    /// Runs `build` and returns its result with the threads that it has started. They are counted when `build` returns,
    /// however long it takes; a clone that is checked later has them too.
    pub fn started_by<T>(build: impl FnOnce() -> T) -> (T, Self) {
        let others = running().unwrap_or_default();
        let built = build();
        let own = running().unwrap_or_default().difference(&others).copied().collect();
        (built, Threads { since: Instant::now(), others, own })
    }

    /// Returns the counts if some threads have ended; `None` also if the system does not list threads.
    ///
    /// Threads may end before they are first counted. A thread gets the name that identifies it a moment after its
    /// start.
    pub fn died(&mut self) -> Option<Died> {
        self.judge(&running()?)
    }

    fn judge(&mut self, running: &BTreeSet<u32>) -> Option<Died> {
        let settled = self.since.elapsed() > SETTLED;
        if self.own.len() < STARTED && !settled {
            self.own.extend(running.difference(&self.others));
        }
        let alive = running.intersection(&self.own).count();
        let started = if settled { self.own.len().max(STARTED) } else { self.own.len() };
        (alive < started).then_some(Died { alive, started })
    }
}

/// Threads of this process that the middleware has started; `None` if the system does not list threads.
fn running() -> Option<BTreeSet<u32>> {
    let entries = std::fs::read_dir("/proc/self/task").ok()?;
    let started = entries
        .flatten()
        .filter(|entry| {
            std::fs::read_to_string(entry.path().join("comm")).is_ok_and(|name| name.starts_with("RustDDS"))
        })
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    Some(started.collect())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use super::*;

    fn with_others(others: &[u32]) -> Threads {
        Threads { since: Instant::now(), others: others.iter().copied().collect(), own: BTreeSet::new() }
    }

    fn set(numbers: &[u32]) -> BTreeSet<u32> {
        numbers.iter().copied().collect()
    }

    #[test]
    fn a_thread_that_ends_is_missed_and_those_left_behind_are_not() {
        let mut threads = with_others(&[1, 2]);
        assert_eq!(threads.judge(&set(&[1, 2])), None, "not started yet");
        assert_eq!(threads.judge(&set(&[1, 2, 3, 4])), None);
        assert_eq!(threads.judge(&set(&[3, 4])), None, "the others may end");
        assert_eq!(threads.judge(&set(&[2, 4])), Some(Died { alive: 1, started: 2 }));
    }

    #[test]
    fn a_copy_that_is_asked_late_knows_the_threads() {
        let mut threads = with_others(&[1]);
        threads.own = set(&[2, 3]);
        threads.since = Instant::now().checked_sub(2 * SETTLED).unwrap();
        assert_eq!(threads.clone().judge(&set(&[1, 2, 3])), None);
        assert_eq!(threads.clone().judge(&set(&[1, 2])), Some(Died { alive: 1, started: 2 }));
    }

    #[test]
    fn the_clock_starts_when_the_participant_is_there() {
        let mut begun = None;
        let ((), threads) = Threads::started_by(|| begun = Some(Instant::now()));
        assert!(begun.is_some_and(|begun| threads.since >= begun));
    }

    #[test]
    fn threads_that_ended_before_they_were_counted_are_missed_once_they_should_be_there() {
        let mut threads = with_others(&[1]);
        assert_eq!(threads.judge(&set(&[1, 3])), None);
        threads.since = Instant::now().checked_sub(2 * SETTLED).unwrap();
        assert_eq!(threads.judge(&set(&[1, 3])), Some(Died { alive: 1, started: 2 }));
    }
}
