//! Stamps of simulated samples.
//!
//! Samples are exactly one period apart, so their stamps should be too, whatever the scheduler does. They follow the
//! system's clock slowly, as that clock itself is corrected slowly, and jump with it when it jumps.

/// Largest correction per sample, as part of the period: twice the 500 ppm at which clocks are disciplined.
const SLEW: f64 = 1e-3;
/// Distance at which the clock has jumped or the simulation has lost its pace, ns.
const JUMP: i64 = 100_000_000;

/// Stamps of samples `period` apart.
pub(super) struct Stamps {
    period: i64,
    next: Option<i64>,
}

impl Stamps {
    /// Samples `period` nanoseconds apart.
    pub fn new(period: i64) -> Self {
        Stamps { period, next: None }
    }

    /// Leaves out `samples` samples.
    pub fn skip(&mut self, samples: i64) {
        if let Some(next) = &mut self.next {
            *next = next.saturating_add(samples.saturating_mul(self.period));
        }
    }

    /// Stamp of the sample taken when the system's clock shows `clock` (ns), and whether it is a new beginning.
    pub fn stamp(&mut self, clock: i64) -> (i64, bool) {
        let (stamp, jumped) = match self.next {
            // No sample is of the future: the first ones came late, and the schedule has caught up with them since. Half
            // steps bring the stamps back within a few samples, and they still go forward.
            Some(expected) if (self.period..=JUMP).contains(&(expected - clock)) => (expected - self.period / 2, false),
            Some(expected) if (clock - expected).abs() <= JUMP => {
                let most = (self.period as f64 * SLEW) as i64;
                (expected + (clock - expected).clamp(-most, most), false)
            }
            known => (clock, known.is_some()),
        };
        self.next = Some(stamp + self.period);
        (stamp, jumped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jitter_of_the_scheduler_does_not_show() {
        let mut stamps = Stamps::new(1_000_000);
        let mut previous = stamps.stamp(0).0;
        for sample in 1..1000_i64 {
            let jitter = if sample % 2 == 0 { 300_000 } else { 0 };
            let (stamp, jumped) = stamps.stamp(sample * 1_000_000 + jitter);
            assert!(!jumped);
            assert!((stamp - previous - 1_000_000).abs() <= 1000);
            previous = stamp;
        }
    }

    #[test]
    fn a_late_beginning_does_not_put_later_stamps_into_the_future() {
        let mut stamps = Stamps::new(4_000_000);
        // The first sample is taken 20 ms late, the next ones at once, until the schedule is met.
        let clocks = (0..100_i64).map(|sample| (sample * 4_000_000).max(20_000_000 + sample * 1000));
        let ahead: Vec<(i64, i64)> = clocks.map(|clock| (stamps.stamp(clock).0, clock)).collect();
        assert!(ahead.windows(2).all(|pair| pair[1].0 > pair[0].0));
        assert!(ahead[20..].iter().all(|(stamp, clock)| stamp - clock <= 4_000_000), "{ahead:?}");
    }

    #[test]
    fn a_drifting_clock_is_followed_and_a_jump_is_told() {
        let mut stamps = Stamps::new(1_000_000);
        let drifting = |sample: i64| sample * 1_000_500;
        let last = (0..10_000).map(|sample| stamps.stamp(drifting(sample)).0).last();
        assert!(last.is_some_and(|stamp| (stamp - drifting(9_999)).abs() < 2_000));
        assert_eq!(stamps.stamp(-5_000_000_000), (-5_000_000_000, true));
    }
}
