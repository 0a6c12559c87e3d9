//! A loop at a constant rate.

use std::time::{Duration, Instant};

use nix::sys::time::TimeSpec;
use nix::time::{ClockId, ClockNanosleepFlags, clock_gettime, clock_nanosleep};

/// Delay after which the schedule restarts instead of catching up, s: a burst of late samples is of no use.
const GIVE_UP: Duration = Duration::from_millis(50);

/// Absolute sleeps on the monotonic clock: a late round does not shift the next one.
///
/// ```
/// use excavator_ros::Pace;
///
/// let mut pace = Pace::new(100.0);
/// for _ in 0..3 {
///     // The work of one round stands here.
///     if !pace.wait() {
///         eprintln!("{} rounds were left out", pace.take_missed());
///     }
/// }
/// ```
pub struct Pace {
    period: Duration,
    next: Duration,
    late: u64,
    missed: u64,
}

impl Pace {
    /// A loop of `rate` rounds per second (Hz) that starts now.
    pub fn new(rate: f64) -> Self {
        let period = Duration::try_from_secs_f64(1.0 / rate).unwrap_or(Duration::from_secs(1));
        Pace { period, next: steady_now(), late: 0, missed: 0 }
    }

    /// Sleeps until the next round. Returns `false` if the round is too late; the schedule then restarts.
    pub fn wait(&mut self) -> bool {
        match self.next_round(steady_now()) {
            Some(time) => {
                sleep_until(time);
                true
            }
            None => false,
        }
    }

    /// When the next round begins; `None` if `now` is too late for it, and the schedule restarts now.
    fn next_round(&mut self, now: Duration) -> Option<Duration> {
        self.next += self.period;
        if now <= self.next + GIVE_UP {
            return Some(self.next);
        }
        self.late += 1;
        let missed = (now - self.next).as_nanos() / self.period.as_nanos().max(1);
        self.missed += u64::try_from(missed).unwrap_or_default();
        self.next = now;
        None
    }

    /// Number of rounds skipped since the last call.
    pub fn take_missed(&mut self) -> u64 {
        std::mem::take(&mut self.missed)
    }

    /// How often the schedule had to restart.
    pub fn late(&self) -> u64 {
        self.late
    }
}

fn steady_now() -> Duration {
    clock_gettime(ClockId::CLOCK_MONOTONIC).map_or(Duration::ZERO, Duration::from)
}

fn sleep_until(time: Duration) {
    let target = TimeSpec::from_duration(time);
    loop {
        match clock_nanosleep(ClockId::CLOCK_MONOTONIC, ClockNanosleepFlags::TIMER_ABSTIME, &target) {
            Err(nix::Error::EINTR) => {}
            Ok(_) => return,
            Err(_) => {
                // No absolute sleep on this system: sleep for the remaining time.
                let start = Instant::now();
                std::thread::sleep(time.saturating_sub(steady_now()));
                if start.elapsed() == Duration::ZERO {
                    std::thread::yield_now();
                }
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn milliseconds(count: u64) -> Duration {
        Duration::from_millis(count)
    }

    #[test]
    fn lateness_of_one_round_does_not_shift_the_others() {
        let mut pace = Pace { next: Duration::ZERO, ..Pace::new(100.0) };
        for round in 1..20 {
            let late = if round == 5 { milliseconds(25) } else { Duration::ZERO };
            let now = milliseconds(10 * (round - 1)) + late;
            assert_eq!(pace.next_round(now), Some(milliseconds(10 * round)), "round {round}");
        }
        assert_eq!((pace.late(), pace.take_missed()), (0, 0));
    }

    #[test]
    fn a_long_delay_starts_the_schedule_anew() {
        let mut pace = Pace { next: Duration::ZERO, ..Pace::new(1000.0) };
        assert_eq!(pace.next_round(milliseconds(80)), None);
        assert_eq!((pace.late(), pace.take_missed(), pace.take_missed()), (1, 79, 0));
        assert_eq!(pace.next_round(milliseconds(80)), Some(milliseconds(81)));
    }

    #[test]
    fn a_round_never_begins_before_its_time() {
        let start = Instant::now();
        let mut pace = Pace::new(100.0);
        while !pace.wait() {}
        assert!(start.elapsed() >= milliseconds(9));
    }
}
