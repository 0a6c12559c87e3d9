//! The clocks of one topic: rate, gaps, jitter, and whether log times and stamps agree.

use serde::Serialize;

use crate::dynamic::{Definitions, Layout, Selector};
use crate::raw_messages::{RawMessage, Topic};

/// An interval longer than this many median intervals is a gap.
const GAP_FACTOR: f64 = 1.5;
/// Share of the intervals that jitter covers: the rest are gaps or bursts, told apart.
const JITTER_SHARE: f64 = 0.95;

/// How regular a topic is. Intervals are those of the stamps where the messages have them, else of the log times.
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

/// The times of one topic as they come.
#[derive(Debug, Default)]
pub(super) struct Times {
    log: Vec<i64>,
    stamps: Vec<i64>,
    reader: Option<(Layout, Selector)>,
}

impl Times {
    /// For messages of a topic; stamps are read where its type has a header.
    pub fn of(topic: &Topic) -> Times {
        let reader = || {
            let layout = Layout::of_topic(topic, &Definitions::default()).ok()?;
            let selector = Selector::time(&layout, &"header.stamp".parse().ok()?).ok()?;
            Some((layout, selector))
        };
        let reader = (topic.message_encoding == "cdr").then(reader).flatten();
        Times { log: Vec::new(), stamps: Vec::new(), reader }
    }

    pub fn note(&mut self, message: &RawMessage) {
        self.log.push(i64::try_from(message.log_time).unwrap_or(i64::MAX));
        if let Some((layout, selector)) = &self.reader
            && let Ok(Some(stamp)) = selector.read_time(layout, &message.data)
        {
            self.stamps.push(stamp);
        }
    }

    /// `None` for fewer than two messages.
    pub fn timing(&self) -> Option<Timing> {
        let stamps = (self.stamps.len() == self.log.len()).then(|| self.stamp_timing()).flatten();
        let from_stamps = stamps.as_ref().is_some_and(|stamps| stamps.zero == 0);
        let mut times = if from_stamps { self.stamps.clone() } else { self.log.clone() };
        times.sort_unstable();
        let steps: Vec<f64> = times.windows(2).map(|pair| seconds(pair[1].saturating_sub(pair[0]))).collect();
        let median = median(&steps)?;
        let differences: Vec<f64> = steps.iter().map(|step| (step - median).abs()).collect();
        let (longest_at, longest) =
            steps.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
        Some(Timing {
            from_stamps,
            median_interval: median,
            jitter: quantile(&differences, JITTER_SHARE)?,
            gaps: steps.iter().filter(|&&step| step > GAP_FACTOR * median).count() as u64,
            longest_interval: longest,
            longest_interval_at: seconds(times.get(longest_at)?.saturating_sub(*times.first()?)),
            log_times_backwards: backwards(&self.log).0,
            stamps,
        })
    }

    fn stamp_timing(&self) -> Option<StampTiming> {
        let delays: Vec<f64> =
            self.log.iter().zip(&self.stamps).map(|(log, stamp)| seconds(log.saturating_sub(*stamp))).collect();
        let (backwards, repeated) = backwards(&self.stamps);
        Some(StampTiming {
            // A simulation may begin at zero: then the log time does as well.
            zero: self.stamps.iter().zip(&self.log).filter(|&(&stamp, &log)| stamp == 0 && log != 0).count() as u64,
            backwards,
            repeated,
            median_delay: median(&delays)?,
            delay_range: (
                delays.iter().copied().fold(f64::INFINITY, f64::min),
                delays.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ),
        })
    }
}

/// How many times are earlier than, and equal to, the latest before them.
fn backwards(times: &[i64]) -> (u64, u64) {
    let (mut earlier, mut equal, mut latest) = (0, 0, None);
    for &time in times {
        earlier += u64::from(latest.is_some_and(|latest| time < latest));
        equal += u64::from(latest == Some(time));
        latest = latest.max(Some(time));
    }
    (earlier, equal)
}

fn seconds(nanoseconds: i64) -> f64 {
    nanoseconds as f64 / 1e9
}

fn median(values: &[f64]) -> Option<f64> {
    quantile(values, 0.5)
}

/// The value that this share of the values does not exceed.
fn quantile(values: &[f64], share: f64) -> Option<f64> {
    let mut values = values.to_vec();
    let place = (values.len().checked_sub(1)? as f64 * share) as usize;
    Some(*values.select_nth_unstable_by(place, f64::total_cmp).1)
}
