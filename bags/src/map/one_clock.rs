//! Whether the stamps in headers and the log times of the mapped topics are one clock, and what is read if not.
//!
//! A topic whose type has no header has log times only. Beside it, stamps of another clock (a device, a simulation, another
//! computer) would shift signals against each other. So either all topics are read by their stamps, or, if these are no
//! common clock, all by their log times.

use super::clock_source::Stamp;
use super::error::MapError;
use super::least_delays::{DRIFT, LeastDelays, STANDS};
use super::mapped_topic::MappedTopic;

/// Stamps this much later than their log times are impossible on one clock, ns. Some recorders round log times to ms.
const IMPOSSIBLE: i64 = -2_000_000;
/// Least delay up to which messages may just be slow, ns: a driver that waits for its device, a filter, a network.
const SLOW: i64 = 20_000_000;
/// As [`SLOW`], for topics that all have stamps, ns: these are right for slow messages too.
const SLOW_WITH_STAMPS: i64 = 100_000_000;
/// Rates of two clocks that are both seconds, s/s. Crystals differ by 0.0001; only a simulation or a replay leaves this.
const RATES: std::ops::RangeInclusive<f64> = 0.95..=1.05;
/// Maximum number of topics listed in a line.
const LISTED: usize = 4;

/// Why `auto` stamps are no common clock for these topics, in one line; `None` if they are. `clock` is the topic of the
/// clock.
///
/// # Errors
/// [`MapError::ClockRates`] if the log times are no substitute.
pub(super) fn why_by_log_times(topics: &[MappedTopic], clock: &str) -> Result<Option<String>, MapError> {
    let by_header: Vec<&MappedTopic> = topics.iter().filter(|topic| is_by_header(topic, clock)).collect();
    if by_header.is_empty() || by_header.iter().all(|topic| topic.delays().has_one_log_time()) {
        return Ok(None);
    }
    let by_log: Vec<&MappedTopic> = topics.iter().filter(|topic| is_by_log(topic, clock)).collect();
    let stands = |topic: &MappedTopic| topic.delays().rate().is_some_and(|rate| rate < STANDS);
    if let Some(topic) = by_header.iter().find(|topic| stands(topic)) {
        return Ok(Some(line(topic, "they are no clock")));
    }
    if by_log.is_empty() {
        return Ok(differing(&by_header).map(|topic| line(topic, "other mapped topics have stamps of another clock")));
    }
    let differs = |topic: &MappedTopic| differs_from_log(topic, clock);
    let Some(topic) = by_header.iter().find(|topic| differs(topic)) else { return Ok(None) };
    // A clock alone may be moved: its samples are only moments at which signals are wanted.
    let has_signals = topic.stamp_uses(false).iter().any(|used| *used.policy == Stamp::Auto);
    if let Some(rate) = topic.delays().rate().filter(|rate| has_signals && !RATES.contains(rate)) {
        let (topic, others) = (topic.name.clone(), names(&by_log));
        return Err(MapError::ClockRates { topic, rate, others });
    }
    let reason = format!("{} {} read by log times", names(&by_log), if by_log.len() == 1 { "is" } else { "are" });
    Ok(Some(line(topic, &reason)))
}

/// Warns of stamps that the map asks for by name and that are not on the clock of the others.
pub(super) fn warnings(topics: &[MappedTopic], clock: &str) -> Vec<String> {
    let is_explicit = |topic: &&MappedTopic| {
        topic.stamp_uses(topic.name == clock).iter().any(|used| *used.policy == Stamp::Header)
            && differs_from_log(topic, clock)
            && !topic.delays().has_one_log_time()
    };
    if !topics.iter().any(|topic| is_by_log(topic, clock)) {
        return Vec::new();
    }
    let warning = |topic: &MappedTopic| {
        format!(
            "stamps in the headers of {} {}, which other signals have: stamp = \"log\" puts all on one clock, or `time_shift` moves them",
            topic.name,
            topic.delays().text()
        )
    };
    topics.iter().filter(is_explicit).map(warning).collect()
}

fn line(topic: &MappedTopic, reason: &str) -> String {
    format!(
        "clock: log times for all mapped topics, because stamps in the headers of {} {}, and {reason}; stamp = \"header\" uses them all the same",
        topic.name,
        topic.delays().text()
    )
}

fn names(topics: &[&MappedTopic]) -> String {
    let mut names: Vec<&str> = topics.iter().take(LISTED).map(|topic| topic.name.as_str()).collect();
    if topics.len() > LISTED {
        names.push("others");
    }
    names.join(", ")
}

/// Whether stamps in headers are used because nothing else is asked for.
fn is_by_header(topic: &MappedTopic, clock: &str) -> bool {
    topic.delays().messages() > 0
        && topic.stamp_uses(topic.name == clock).iter().any(|used| *used.policy == Stamp::Auto)
}

fn is_by_log(topic: &MappedTopic, clock: &str) -> bool {
    topic.stamp_uses(topic.name == clock).iter().any(|used| match used.policy {
        Stamp::Log => true,
        Stamp::Auto => topic.unstamped() > 0,
        Stamp::Header | Stamp::Field(_) => false,
    })
}

/// Whether its stamps are not on the clock of the log, neither as they are nor with the shift of the map.
fn differs_from_log(topic: &MappedTopic, clock: &str) -> bool {
    let Some((least, most)) = topic.delays().range() else { return false };
    let fits = |shift: i64| {
        let (least, most) = (least.saturating_sub(shift), most.saturating_sub(shift));
        least >= IMPOSSIBLE && most <= SLOW && most.saturating_sub(least) <= DRIFT.max(SLOW / 2)
    };
    !topic.stamp_uses(topic.name == clock).iter().any(|used| fits(used.shift)) && !fits(0)
}

/// A topic whose stamps are of another clock than those of the others.
fn differing<'t, 'm>(topics: &[&'t MappedTopic<'m>]) -> Option<&'t MappedTopic<'m>> {
    let delays = |topic: &&'t MappedTopic<'m>| topic.delays();
    let from = topics.iter().map(|topic| delays(topic).span().0).min()?;
    let to = topics.iter().map(|topic| delays(topic).span().1).max()?;
    let parts: Vec<Vec<_>> = topics.iter().map(|topic| delays(topic).parts((from, to))).collect();
    let first = parts.first()?;
    let differs = |index: &usize| {
        first.iter().zip(&parts[*index]).any(|(one, other)| {
            let Some((one, other)) = one.zip(*other) else { return false };
            let apart = one.delay.saturating_sub(other.delay).saturating_abs();
            let is_impossible = one.delay.min(other.delay) < IMPOSSIBLE;
            apart > if is_impossible { SLOW } else { SLOW_WITH_STAMPS }
        })
    };
    let found = (1..topics.len()).find(differs)?;
    // The one that is farther from the log is named.
    let distance = |topic: &LeastDelays| {
        topic.range().map_or(0, |(least, most)| least.saturating_abs().max(most.saturating_abs()))
    };
    let (one, other) = (topics[0], topics[found]);
    Some(if distance(one.delays()) > distance(other.delays()) { one } else { other })
}

/// A line about a signal that two publishers wrote at the same time.
pub(super) fn two_publishers(label: &str, values: u64, values_of_other: u64) -> String {
    format!(
        "{label}: two publishers write its topic at the same time, through channels of their own; the {values_of_other} values of one are \
         used, the {values} of the other are left out"
    )
}
