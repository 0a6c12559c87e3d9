//! Stamps of simulated samples.
//!
//! A stamp is the machine's own time: samples are exactly one period apart, and so are their stamps, whatever the scheduler
//! does. If a stamp followed the moment at which a sample was computed, a starved computer would change the physics: the slopes
//! of the signals would no longer fit the powers. Stamps follow the system clock slowly, as that clock itself is corrected
//! slowly, and jump when it jumps.

/// Largest correction per sample, as a share of the period: twice the 500 ppm limit of clock discipline.
const SLEW: f64 = 1e-3;
/// Offset above which the clock has jumped or the simulation has lost its pace, ns.
const JUMP: i64 = 100_000_000;
/// A clock that is ahead counts as jumped if it stays ahead for this long by its own time, ns. Until the next samples come, a
/// sample that was computed late looks the same.
const LASTING: i64 = 1_000_000_000;

/// Stamps of samples `period` apart.
pub(super) struct Stamps {
    period: i64,
    last: Option<(u64, i64)>,
    /// System clock at the last sample, ns.
    last_clock: i64,
    /// Time on the clock since which it has been ahead by more than a jump, ns.
    ahead_since: Option<i64>,
}

impl Stamps {
    /// Samples `period` nanoseconds apart.
    pub fn new(period: i64) -> Self {
        Stamps { period, last: None, last_clock: i64::MIN, ahead_since: None }
    }

    /// Stamp of this sample, taken when the system clock shows `clock` (ns), and whether the stamps restart here.
    pub fn stamp(&mut self, sample: u64, clock: i64) -> (i64, bool) {
        let (stamp, jumped) = match self.last {
            None => (clock, false),
            Some((number, stamp)) => {
                let samples = i64::try_from(sample.saturating_sub(number)).unwrap_or(i64::MAX);
                self.next(stamp.saturating_add(samples.saturating_mul(self.period)), samples, clock)
            }
        };
        self.last = Some((sample, stamp));
        self.last_clock = clock;
        (stamp, jumped)
    }

    /// The expected stamp, corrected; or the clock if it has jumped.
    fn next(&mut self, expected: i64, samples: i64, clock: i64) -> (i64, bool) {
        let ahead = clock.saturating_sub(expected);
        if ahead <= JUMP {
            self.ahead_since = None;
        }
        let since = (ahead > JUMP).then(|| *self.ahead_since.get_or_insert(clock));
        // Stamps go back only if the clock itself does, not if the simulation caught up by too many samples.
        let set_back = ahead < -JUMP && clock < self.last_clock;
        let has_jumped = set_back || since.is_some_and(|since| !(0..LASTING).contains(&(clock - since)));
        if has_jumped {
            self.ahead_since = None;
            return (clock, true);
        }
        let most = (self.period as f64 * SLEW * samples as f64) as i64;
        (expected.saturating_add(ahead.clamp(-most, most)), false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: i64 = 1_000_000;

    #[test]
    fn jitter_of_the_scheduler_does_not_show() {
        let mut stamps = Stamps::new(PERIOD);
        let mut previous = stamps.stamp(0, 0).0;
        for sample in 1..1000_u32 {
            let jitter = if sample % 2 == 0 { 300_000 } else { 0 };
            let (stamp, jumped) = stamps.stamp(sample.into(), i64::from(sample) * PERIOD + jitter);
            assert!(!jumped);
            assert!((stamp - previous - PERIOD).abs() <= 1000);
            previous = stamp;
        }
    }

    /// A core is unavailable for 300 ms: one sample comes late, and the next one has to make up for the others.
    #[test]
    fn a_starved_computer_does_not_change_the_time_between_samples() {
        let mut stamps = Stamps::new(PERIOD);
        let before = (0..500_i64).map(|sample| (sample, sample));
        let late = [(500_i64, 800_i64)].into_iter();
        let after = (801..1500_i64).map(|sample| (sample, sample));
        let mut previous: Option<(i64, i64)> = None;
        for (sample, milliseconds) in before.chain(late).chain(after) {
            let (stamp, jumped) = stamps.stamp(sample.unsigned_abs(), milliseconds * PERIOD);
            assert!(!jumped);
            if let Some((number, before)) = previous {
                let interval = (sample - number) * PERIOD;
                assert!((stamp - before - interval).abs() <= interval / 1000, "at sample {sample}");
            }
            previous = Some((sample, stamp));
        }
    }

    #[test]
    fn a_drifting_clock_is_followed_and_a_jump_is_told() {
        let mut stamps = Stamps::new(PERIOD);
        let drifting = |sample: i64| sample * 1_000_500;
        let last = (0..10_000_i64).map(|sample| stamps.stamp(sample.unsigned_abs(), drifting(sample)).0).last();
        assert!(last.is_some_and(|stamp| (stamp - drifting(9_999)).abs() < 2_000));
        assert_eq!(stamps.stamp(10_000, -5_000_000_000), (-5_000_000_000, true));
    }

    /// The first sample was stamped late, and the next ones followed at once.
    #[test]
    fn stamps_do_not_go_back_while_the_clock_does_not() {
        let mut stamps = Stamps::new(PERIOD);
        let mut previous = stamps.stamp(0, 400 * PERIOD).0;
        for sample in 1..2000_i64 {
            let (stamp, jumped) = stamps.stamp(sample.unsigned_abs(), sample.max(401) * PERIOD);
            assert!(!jumped && stamp > previous, "at sample {sample}");
            previous = stamp;
        }
    }

    #[test]
    fn a_clock_set_forward_is_followed_after_a_second() {
        let mut stamps = Stamps::new(PERIOD);
        stamps.stamp(0, 0);
        let hour = 3_600_000_000_000;
        let jump = (1..3000_u32).find(|&sample| stamps.stamp(sample.into(), hour + i64::from(sample) * PERIOD).1);
        assert_eq!(jump, Some(1001));
    }
}
