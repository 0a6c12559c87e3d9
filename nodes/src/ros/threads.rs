//! The threads of the middleware: they end, and say nothing, when a system call of theirs is interrupted (SIGSTOP and
//! SIGCONT, a frozen container, suspend to disk).

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

/// Threads that the middleware starts for a participant: one for the wire, one for discovery.
const STARTED: usize = 2;

/// Time after which these have started: a hundred times what it takes.
const SETTLED: Duration = Duration::from_secs(1);

/// The threads of one participant.
#[derive(Debug, Clone)]
pub(super) struct Threads {
    since: Instant,
    /// Threads of others, and of participants that were left behind.
    others: BTreeSet<u32>,
    own: BTreeSet<u32>,
}

/// How many of a participant's threads are left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Died {
    pub alive: usize,
    pub started: usize,
}

impl Threads {
    /// Of the participant that is built next.
    pub fn of_the_next() -> Self {
        Threads { since: Instant::now(), others: running().unwrap_or_default(), own: BTreeSet::new() }
    }

    /// Whether some have ended; `None` too where the system does not tell.
    ///
    /// Threads may end before they were ever counted; and they take a name, which they are known by, a moment after their
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

/// Threads of this process that the middleware has started; `None` where the system does not tell.
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
    fn threads_that_ended_before_they_were_counted_are_missed_once_they_should_be_there() {
        let mut threads = with_others(&[1]);
        assert_eq!(threads.judge(&set(&[1, 3])), None);
        threads.since = Instant::now().checked_sub(2 * SETTLED).unwrap();
        assert_eq!(threads.judge(&set(&[1, 3])), Some(Died { alive: 1, started: 2 }));
    }
}
