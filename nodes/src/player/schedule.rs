//! Computes when each message of a bag is due.

use std::time::{Duration, Instant};

/// Maps bag time to the steady clock, with a rate and with pauses.
#[derive(Debug, Clone)]
pub(super) struct Schedule {
    rate: f64,
    /// Bag time (ns) at `anchor`.
    bag_time: u64,
    anchor: Instant,
    paused: bool,
}

impl Schedule {
    /// Bag time is `start` (ns) at `now`, and runs `rate` times as fast as the clock.
    pub fn new(start: u64, rate: f64, now: Instant) -> Self {
        Schedule { rate, bag_time: start, anchor: now, paused: false }
    }

    /// Bag time at `now`, ns.
    pub fn bag_time(&self, now: Instant) -> u64 {
        if self.paused {
            return self.bag_time;
        }
        let passed = now.saturating_duration_since(self.anchor).as_secs_f64() * self.rate;
        self.bag_time.saturating_add((passed * 1e9) as u64)
    }

    /// Time from `now` until the message of bag time `due` (ns); `None` while paused.
    pub fn until(&self, due: u64, now: Instant) -> Option<Duration> {
        if self.paused {
            return None;
        }
        let left = due.saturating_sub(self.bag_time(now)) as f64 * 1e-9 / self.rate;
        Some(Duration::try_from_secs_f64(left).unwrap_or(Duration::MAX))
    }

    /// Whether bag time is paused.
    pub fn is_paused(&self) -> bool {
        self.paused
    }

    /// Pauses bag time, or resumes it where it stopped.
    pub fn set_paused(&mut self, paused: bool, now: Instant) {
        if paused != self.paused {
            self.bag_time = self.bag_time(now);
            self.anchor = now;
            self.paused = paused;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: u64 = 1_000_000_000;

    #[test]
    fn bag_time_runs_at_its_rate() {
        let start = Instant::now();
        let schedule = Schedule::new(10 * SECOND, 2.0, start);
        assert_eq!(schedule.bag_time(start + Duration::from_secs(3)), 16 * SECOND);
        assert_eq!(schedule.until(14 * SECOND, start), Some(Duration::from_secs(2)));
        assert_eq!(schedule.until(9 * SECOND, start), Some(Duration::ZERO));
    }

    #[test]
    fn a_pause_costs_no_message() {
        let start = Instant::now();
        let mut schedule = Schedule::new(0, 1.0, start);
        schedule.set_paused(true, start + Duration::from_secs(1));
        let later = start + Duration::from_secs(100);
        assert_eq!((schedule.bag_time(later), schedule.until(5 * SECOND, later)), (SECOND, None));
        schedule.set_paused(false, later);
        assert_eq!(schedule.until(5 * SECOND, later), Some(Duration::from_secs(4)));
    }
}
