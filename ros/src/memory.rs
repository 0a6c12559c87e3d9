//! Memory of this process: a second protection behind the packet filter.
//!
//! The filter bounds the numbers in packets, but not the number of packets. A flood of small packets makes the
//! middleware grow, and it never frees its records of peers that do not exist. A node needs as much memory after an
//! hour as after a second. A node that has grown too much gets a new participant, which starts without these records.

use std::time::{Duration, Instant};

/// Growth at which the link is rebuilt, MB. A node has 20 to 60.
const MOST_GROWTH: u64 = 96;
/// Time after which a node has opened its endpoints and met its peers.
const SETTLED: Duration = Duration::from_secs(3);

/// Watches the memory of this process.
pub(super) struct Memory {
    since: Instant,
    /// Memory before the first look, MB.
    at_start: u64,
    /// Memory once the process has settled and reference for later looks, MB.
    before: u64,
}

impl Memory {
    /// The reference is the memory once the process has settled. `at_start` is the memory before it joined the graph, MB: the
    /// first flood may be over before the first look. For a rebuilt link it is what the old one has left.
    pub fn new(at_start: u64) -> Self {
        Memory { since: Instant::now(), at_start, before: at_start }
    }

    /// Memory before and now, MB, if it has grown too much.
    pub fn grown(&mut self) -> Option<(u64, u64)> {
        self.judge(resident()?, self.since.elapsed())
    }

    fn judge(&mut self, now: u64, age: Duration) -> Option<(u64, u64)> {
        if age < SETTLED {
            // A flood from the first moment on must not raise the reference.
            self.before = self.before.max(now.min(self.at_start + MOST_GROWTH / 2));
        }
        (now.saturating_sub(self.before) > MOST_GROWTH).then_some((self.before, now))
    }
}

/// Resident memory of this process, MB.
pub(super) fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kilobytes| kilobytes / 1024)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn at(memory: &mut Memory, megabytes: u64, seconds: u64) -> Option<(u64, u64)> {
        memory.judge(megabytes, Duration::from_secs(seconds))
    }

    #[test]
    fn this_process_has_some_memory() {
        assert!(resident().is_some_and(|megabytes| (1..100_000).contains(&megabytes)));
    }

    #[test]
    fn what_a_node_needs_at_its_start_is_not_growth() {
        let mut memory = Memory::new(15);
        assert_eq!(at(&mut memory, 20, 0), None);
        assert_eq!(at(&mut memory, 60, 2), None);
        assert_eq!(at(&mut memory, 60 + MOST_GROWTH, 3600), None);
        assert_eq!(at(&mut memory, 61 + MOST_GROWTH, 3601), Some((60, 61 + MOST_GROWTH)));
    }

    #[test]
    fn a_flood_from_the_start_on_is_found() {
        let mut memory = Memory::new(15);
        let found = (0..100).find_map(|step| memory.judge(20 + 40 * step, Duration::from_millis(250 * step)));
        assert!(found.is_some_and(|(_, now)| now < 400), "{found:?}");
    }

    #[test]
    fn a_flood_that_is_over_before_the_first_look_is_found() {
        let mut memory = Memory::new(15);
        assert_eq!(at(&mut memory, 239, 0), Some((63, 239)));
    }

    #[test]
    fn what_a_rebuild_does_not_release_is_no_reason_for_another() {
        let mut memory = Memory::new(239);
        assert_eq!(at(&mut memory, 239, 0), None);
        assert_eq!(at(&mut memory, 240, 3600), None);
    }
}
