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
        self.next += self.period;
        let now = steady_now();
        if now > self.next + GIVE_UP {
            self.late += 1;
            let missed = (now - self.next).as_nanos() / self.period.as_nanos().max(1);
            self.missed += u64::try_from(missed).unwrap_or_default();
            self.next = now;
            return false;
        }
        sleep_until(self.next);
        true
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

    #[test]
    fn lateness_of_one_round_does_not_shift_the_others() {
        let start = Instant::now();
        let mut pace = Pace::new(100.0);
        for round in 0..20 {
            if round == 5 {
                std::thread::sleep(Duration::from_millis(25));
            }
            pace.wait();
        }
        let elapsed = start.elapsed();
        assert!(elapsed >= Duration::from_millis(199), "{elapsed:?}");
        assert_eq!(pace.late(), 0);
    }

    #[test]
    fn a_long_delay_starts_the_schedule_anew() {
        let mut pace = Pace::new(1000.0);
        std::thread::sleep(Duration::from_millis(80));
        assert!(!pace.wait());
        assert_eq!(pace.late(), 1);
        let missed = pace.take_missed();
        assert!(missed >= 78, "{missed}");
        assert_eq!(pace.take_missed(), 0);
    }
}
