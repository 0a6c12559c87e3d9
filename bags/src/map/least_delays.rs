//! The least delay of messages behind their stamps, in each part of a recording.
//!
//! A message cannot be received before it is made, and now and then one is received at once. So on one clock the least
//! delay is never negative, small, and the same throughout a recording. Anything else shows two clocks.

/// Width of the first bins, ns: several messages of a fast topic.
const FIRST_WIDTH: i64 = 1 << 24;
/// Bins that are kept; with more, neighbours are joined.
const MOST_BINS: usize = 4096;
/// Parts of a recording that are compared.
const PARTS: usize = 8;

/// Log time minus stamp of the messages of one topic, ns.
#[derive(Debug, Clone, Default)]
pub(super) struct LeastDelays {
    messages: u64,
    /// Log time at which the first bin begins, ns.
    start: i64,
    width: i64,
    /// The least delay in each bin; `i64::MAX` without message.
    bins: Vec<i64>,
}

/// The least delay in one part of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    /// Log time of its middle, ns.
    pub at: i64,
    /// ns.
    pub delay: i64,
}

impl LeastDelays {
    /// Adds one message.
    pub fn note(&mut self, log: i64, stamp: i64) {
        if self.messages == 0 {
            (self.start, self.width) = (log, FIRST_WIDTH);
        }
        self.messages += 1;
        let delay = log.saturating_sub(stamp);
        // A message that is logged before the first one belongs to the beginning.
        let since = log.saturating_sub(self.start).max(0);
        while since / self.width >= MOST_BINS as i64 {
            self.bins = self.bins.chunks(2).map(|pair| pair.iter().copied().min().unwrap_or(i64::MAX)).collect();
            self.width = self.width.saturating_mul(2);
        }
        let bin = (since / self.width) as usize;
        if bin >= self.bins.len() {
            self.bins.resize(bin + 1, i64::MAX);
        }
        self.bins[bin] = self.bins[bin].min(delay);
    }

    /// Messages with a stamp.
    pub fn messages(&self) -> u64 {
        self.messages
    }

    /// Log times of the first bin and of the end of the last one, ns.
    pub fn span(&self) -> (i64, i64) {
        (self.start, self.start.saturating_add(self.width.saturating_mul(self.bins.len() as i64)))
    }

    /// Whether all log times are (nearly) the same, so that they are no clock.
    pub fn has_one_log_time(&self) -> bool {
        self.messages > 1 && self.bins.len() <= 1 && self.width == FIRST_WIDTH
    }

    /// The least delay in each of a few equal parts of a span of log times; parts without message are missing. The median
    /// over the bins of a part, so that single wrong stamps have no effect.
    pub fn parts(&self, (from, to): (i64, i64)) -> Vec<Option<Part>> {
        let length = (to.saturating_sub(from) / PARTS as i64).max(1);
        let mut parts: Vec<Vec<i64>> = vec![Vec::new(); PARTS];
        for (bin, &delay) in self.bins.iter().enumerate().filter(|(_, delay)| **delay != i64::MAX) {
            let at = self.start.saturating_add(self.width.saturating_mul(bin as i64));
            let part = at.saturating_sub(from).max(0) / length;
            parts[(part as usize).min(PARTS - 1)].push(delay);
        }
        let middle = |part: usize| from.saturating_add(length.saturating_mul(part as i64)).saturating_add(length / 2);
        let median = |(part, mut delays): (usize, Vec<i64>)| {
            let half = delays.len() / 2;
            let at = middle(part);
            (!delays.is_empty()).then(|| Part { at, delay: *delays.select_nth_unstable(half).1 })
        };
        parts.into_iter().enumerate().map(median).collect()
    }

    /// Least and largest of the least delays of all parts, ns.
    pub fn range(&self) -> Option<(i64, i64)> {
        let parts = || self.parts(self.span()).into_iter().flatten().map(|part| part.delay);
        parts().min().zip(parts().max())
    }

    /// How fast the stamps run, in seconds per second of the log; `None` for a recording that is too short to tell.
    pub fn rate(&self) -> Option<f64> {
        let parts: Vec<Part> = self.parts(self.span()).into_iter().flatten().collect();
        let (first, last) = (parts.first()?, parts.last()?);
        let passed = last.at.saturating_sub(first.at) as f64;
        (passed >= SHORTEST_FOR_A_RATE).then(|| 1.0 - last.delay.saturating_sub(first.delay) as f64 / passed)
    }

    /// What the stamps are in relation to the log times: "60.0 ms later than their log times".
    pub fn text(&self) -> String {
        let Some((least, most)) = self.range() else { return "are not set".to_string() };
        let rate = self.rate().unwrap_or(1.0);
        let apart = (least as f64).abs().max((most as f64).abs()) / 1e9;
        if rate < STANDS {
            return if rate < -STANDS { "run backwards" } else { "stand still" }.to_string();
        }
        if apart > ANOTHER_EPOCH {
            return "are of another epoch than their log times, as those of a simulation".to_string();
        }
        let side = |delay: i64| if delay < 0 { "later" } else { "earlier" };
        if most.saturating_sub(least) > DRIFT {
            let (first, last) = if rate > 1.0 { (most, least) } else { (least, most) };
            return format!(
                "drift from {} {} to {} {} than their log times",
                seconds_text(first),
                side(first),
                seconds_text(last),
                side(last)
            );
        }
        format!("are {} {} than their log times", seconds_text(least), side(least))
    }
}

/// A length of time for people.
pub(super) fn seconds_text(nanoseconds: i64) -> String {
    let seconds = (nanoseconds as f64 / 1e9).abs();
    match seconds {
        0.0..1.0 => format!("{:.1} ms", 1e3 * seconds),
        1.0..1e4 => format!("{seconds:.2} s"),
        _ => format!("{seconds:.3e} s"),
    }
}

/// Change of the least delay that is drift or a step of a clock, ns.
pub(super) const DRIFT: i64 = 5_000_000;
/// Rate below which a clock stands still.
pub(super) const STANDS: f64 = 0.01;
/// Shortest time over which a rate is measured, ns.
const SHORTEST_FOR_A_RATE: f64 = 2e8;
/// Difference of two clocks that no delay explains, s: a month.
const ANOTHER_EPOCH: f64 = 2.6e6;

/// A stretch of times for people, relative to the start of another one, s.
pub(super) fn stretch_text(from: i64, to: i64) -> String {
    let sign = |value: i64| if value < 0 { "-" } else { "" };
    format!("{}{} to {}{}", sign(from), seconds_text(from), sign(to), seconds_text(to))
}
