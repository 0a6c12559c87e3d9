//! One clock of a topic: the intervals between its times, and how often it goes backwards.

use super::spread::{Bins, Spread};

/// Times buffered for sorting. A time that arrives later than this many others produces no interval of its own.
const WAITING: usize = 1 << 15;

/// Times in nanoseconds, in order of arrival.
#[derive(Debug, Default)]
pub(super) struct Clock {
    count: u64,
    latest: Option<i64>,
    backwards: u64,
    repeated: u64,
    waiting: Vec<i64>,
    first: Option<i64>,
    /// The last time that left the buffer.
    last: Option<i64>,
    intervals: Spread,
    longest: i64,
    longest_from: i64,
}

/// The intervals between the sorted times of a clock.
#[derive(Debug)]
pub(super) struct Intervals {
    /// All of them, ns.
    pub bins: Bins,
    /// The longest, ns.
    pub longest: i64,
    /// When that interval began, ns after the first time.
    pub longest_at: i64,
}

impl Clock {
    /// Adds one time.
    pub fn note(&mut self, time: i64) {
        self.count += 1;
        self.backwards += u64::from(self.latest.is_some_and(|latest| time < latest));
        self.repeated += u64::from(self.latest == Some(time));
        self.latest = self.latest.max(Some(time));
        self.waiting.push(time);
        if self.waiting.len() >= 2 * WAITING {
            self.settle(WAITING);
        }
    }

    /// Number of times.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Number of times that were earlier than a previous one.
    pub fn backwards(&self) -> u64 {
        self.backwards
    }

    /// Number of times that were equal to the latest previous one.
    pub fn repeated(&self) -> u64 {
        self.repeated
    }

    /// The intervals; `None` for fewer than two times.
    pub fn intervals(&mut self) -> Option<Intervals> {
        self.settle(self.waiting.len());
        Some(Intervals {
            bins: (self.count > 1).then(|| self.intervals.bins())?,
            longest: self.longest,
            longest_at: self.longest_from.saturating_sub(self.first?),
        })
    }

    /// Converts the earliest `count` buffered times to intervals.
    fn settle(&mut self, count: usize) {
        self.waiting.sort_unstable();
        for time in self.waiting.drain(..count) {
            self.first.get_or_insert(time);
            let Some(last) = self.last else {
                self.last = Some(time);
                continue;
            };
            if time < last {
                continue;
            }
            let interval = time.saturating_sub(last);
            self.intervals.note(interval);
            if interval >= self.longest {
                (self.longest, self.longest_from) = (interval, last);
            }
            self.last = Some(time);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn times_out_of_order_make_the_intervals_of_the_sorted_ones() {
        let mut clock = Clock::default();
        for block in 0..20_000_i64 {
            for time in [2, 1, 0, 0, 9] {
                clock.note(10 * block + time);
            }
        }
        assert_eq!((clock.count(), clock.backwards(), clock.repeated()), (100_000, 3 * 20_000, 0));
        let intervals = clock.intervals().unwrap();
        assert_eq!(intervals.bins.count(|_| true), 99_999);
        assert_eq!(intervals.bins.count(|interval| interval == 7), 20_000);
        assert_eq!((intervals.longest, intervals.longest_at), (7, 10 * 19_999 + 2));
    }

    #[test]
    fn a_time_far_too_late_makes_no_interval() {
        let mut clock = Clock::default();
        (0..4 * WAITING as i64).for_each(|time| clock.note(time));
        clock.note(5);
        assert_eq!(clock.backwards(), 1);
        assert_eq!(clock.intervals().unwrap().bins.count(|interval| interval == 1), 4 * WAITING as u64 - 1);
        assert!(Clock::default().intervals().is_none());
    }
}
