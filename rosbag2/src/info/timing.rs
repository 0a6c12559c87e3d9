//! The clocks of one topic: rate, gaps, jitter, and whether log times and stamps agree.

use serde::Serialize;

use super::clock::Clock;
use super::spread::Spread;
use crate::dynamic::{Definitions, Layout, Selector};
use crate::raw_message::{RawMessage, Topic};

/// An interval longer than this many median intervals is a gap.
const GAP_FACTOR: f64 = 1.5;
/// Share of the intervals that jitter covers: the rest are gaps or bursts, which are reported separately.
const JITTER_SHARE: f64 = 0.95;

/// How regular a topic is. Intervals are those of the stamps where the messages have them, else of the log times.
///
/// Medians and jitter are exact for up to 262 144 messages; beyond, they are within 0.1 % of their distance from the median
/// of the first so many. Counts and extremes are always exact.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Timing {
    /// Whether intervals are those of the stamps in the headers.
    pub from_stamps: bool,
    /// Median interval, s.
    pub median_interval: f64,
    /// 95 % of the intervals differ from the median by no more than this, s.
    pub jitter: f64,
    /// Intervals longer than 1.5 medians.
    pub gaps: u64,
    /// The longest interval, s.
    pub longest_interval: f64,
    /// When it began, s after the first message of the topic.
    pub longest_interval_at: f64,
    /// Messages with an earlier log time than one before them.
    pub log_times_backwards: u64,
    /// What the stamps say; `None` for messages without.
    pub stamps: Option<StampTiming>,
}

/// The stamps in the headers of one topic.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StampTiming {
    /// Stamps of zero: never set.
    pub zero: u64,
    /// Stamps earlier than one before them.
    pub backwards: u64,
    /// Stamps equal to one before them.
    pub repeated: u64,
    /// Median of log time minus stamp, s: age of the messages on arrival, or how far two clocks are apart.
    pub median_delay: f64,
    /// Least and largest log time minus stamp, s.
    pub delay_range: (f64, f64),
}

/// The times of one topic in order of arrival.
#[derive(Debug, Default)]
pub(super) struct Times {
    log: Clock,
    stamps: Clock,
    /// Log time minus stamp, ns.
    delays: Spread,
    /// Least and largest of them.
    delay_range: Option<(i64, i64)>,
    zero_stamps: u64,
    reader: Option<(Layout, Selector)>,
}

impl Times {
    /// For messages of a topic; stamps are read if its type has a header.
    pub fn of(topic: &Topic, extra: &Definitions) -> Times {
        let reader = || {
            let layout = Layout::of_topic(topic, extra).ok()?;
            let selector = Selector::time(&layout, &"header.stamp".parse().ok()?).ok()?;
            Some((layout, selector))
        };
        Times { reader: (topic.message_encoding == "cdr").then(reader).flatten(), ..Times::default() }
    }

    pub fn note(&mut self, message: &RawMessage) {
        let log = i64::try_from(message.log_time).unwrap_or(i64::MAX);
        self.log.note(log);
        if let Some((layout, selector)) = &self.reader
            && let Ok(Some(stamp)) = selector.read_time(layout, &message.data)
        {
            self.note_stamp(stamp, log);
        }
    }

    fn note_stamp(&mut self, stamp: i64, log: i64) {
        self.stamps.note(stamp);
        let delay = log.saturating_sub(stamp);
        self.delays.note(delay);
        let (least, largest) = self.delay_range.unwrap_or((delay, delay));
        self.delay_range = Some((least.min(delay), largest.max(delay)));
        // A simulation may start at zero: then the log time is zero as well.
        self.zero_stamps += u64::from(stamp == 0 && log != 0);
    }

    /// `None` for fewer than two messages.
    pub fn timing(mut self) -> Option<Timing> {
        let stamps = (self.stamps.count() == self.log.count()).then(|| self.stamp_timing()).flatten();
        let from_stamps = stamps.as_ref().is_some_and(|stamps| stamps.zero == 0);
        let log_times_backwards = self.log.backwards();
        let clock = if from_stamps { &mut self.stamps } else { &mut self.log };
        let intervals = clock.intervals()?;
        let median = intervals.bins.quantile(0.5)?;
        Some(Timing {
            from_stamps,
            median_interval: seconds(median),
            jitter: seconds(intervals.bins.distances_from(median).quantile(JITTER_SHARE)?),
            gaps: intervals.bins.count(|interval| interval as f64 > GAP_FACTOR * median as f64),
            longest_interval: seconds(intervals.longest),
            longest_interval_at: seconds(intervals.longest_at),
            log_times_backwards,
            stamps,
        })
    }

    fn stamp_timing(&self) -> Option<StampTiming> {
        let (least, largest) = self.delay_range?;
        Some(StampTiming {
            zero: self.zero_stamps,
            backwards: self.stamps.backwards(),
            repeated: self.stamps.repeated(),
            median_delay: seconds(self.delays.bins().quantile(0.5)?),
            delay_range: (seconds(least), seconds(largest)),
        })
    }
}

fn seconds(nanoseconds: i64) -> f64 {
    nanoseconds as f64 / 1e9
}
