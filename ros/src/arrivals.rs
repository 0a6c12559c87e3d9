//! Notices that a reader has fallen silent although its writer goes on.
//!
//! A GAP or a HEARTBEAT may declare any number of samples irrelevant, and a late joiner depends on that: a writer that
//! has run for days tells it to begin with number 10^8. The same packet, forged in the name of a writer, makes a reader
//! skip all samples for years. The reader itself cannot tell: it has received nothing that it lacks.
//!
//! A second reader of the same topic can, since the packet was addressed to the first. It is opened once a writer that
//! is still present has fallen silent. Samples that only the second one delivers prove that the first one is deaf, and
//! the second takes its place. A writer that merely pauses is silent on both; the second reader is closed again, and the
//! next attempt comes later. The first reader is never disturbed without proof.

use std::collections::{BTreeSet, HashMap};
use std::time::{Duration, Instant};

/// Identity of a writer.
pub type Writer = [u8; 16];

/// Samples after which the usual interval of a writer is known.
const KNOWN: u32 = 8;
/// Usual intervals without a sample until a writer counts as silent. Writers that share a processor are late by two.
const INTERVALS: u32 = 5;
/// Shortest time without a sample that counts as silence: pauses of a busy machine are shorter.
const SHORTEST: Duration = Duration::from_secs(1);
/// Time that the second reader may deliver alone before the first one counts as deaf. Both take a sample from the same
/// packet, or from repairs of lost packets, which take some 0.1 s.
const LEAD: Duration = Duration::from_millis(250);
/// Life of a second reader that hears nothing: ten times what it takes to match a writer.
const TRIAL: Duration = Duration::from_secs(3);
/// Pauses between two trials: the first, and the longest. A writer that pauses for hours costs one reader in five minutes.
const PAUSES: [Duration; 2] = [Duration::from_secs(10), Duration::from_secs(300)];
/// Samples without a silence after which the next trial may come at once.
const STEADY: u32 = 64;
/// Largest number of writers whose intervals are kept. A topic has a handful; the limit bounds the memory.
const MOST_WRITERS: usize = 256;

/// Samples of one writer.
#[derive(Debug, Clone, Copy)]
struct Heard {
    sequence: i64,
    at: Instant,
    samples: u32,
    /// Longest interval lately; fades by an eighth with each shorter one.
    interval: Duration,
}

impl Heard {
    fn silence(&self) -> Duration {
        (self.interval * INTERVALS).max(SHORTEST)
    }

    fn is_silent(&self, now: Instant) -> bool {
        self.samples >= KNOWN && now.saturating_duration_since(self.at) > self.silence()
    }
}

/// A second reader on trial.
#[derive(Debug)]
struct Second {
    number: u64,
    opened: Instant,
    /// The writers that had fallen silent.
    silent: HashMap<Writer, Trial>,
}

/// What the trial has shown of one writer so far.
#[derive(Debug, Clone, Copy, Default)]
struct Trial {
    /// Since when the second reader has delivered samples that the first one did not.
    leads_since: Option<Instant>,
    /// Whether the first reader has delivered a sample meanwhile.
    first_delivers: bool,
}

impl Trial {
    fn is_proof(&self, now: Instant) -> bool {
        !self.first_delivers && self.leads_since.is_some_and(|since| now.saturating_duration_since(since) >= LEAD)
    }
}

/// What to do about the readers of a topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// Nothing.
    Wait,
    /// Open a second reader.
    Open,
    /// Close the reader with this number: it was not needed.
    Close(u64),
    /// Close the reader with this number: it is deaf, and the other one has taken its place.
    Replace(u64),
}

/// Arrivals of one topic, from its one or two readers.
#[derive(Debug)]
pub(super) struct Arrivals {
    writers: HashMap<Writer, Heard>,
    last_number: u64,
    first: Option<u64>,
    second: Option<Second>,
    pause: Duration,
    /// No trial before.
    quiet_until: Option<Instant>,
    steady: u32,
}

impl Default for Arrivals {
    fn default() -> Self {
        Arrivals {
            writers: HashMap::new(),
            last_number: 0,
            first: None,
            second: None,
            pause: PAUSES[0],
            quiet_until: None,
            steady: 0,
        }
    }
}

impl Arrivals {
    /// Number of a new reader: the first one, or one on trial.
    pub fn enter(&mut self, now: Instant) -> u64 {
        self.last_number += 1;
        let number = self.last_number;
        match self.first {
            None => self.first = Some(number),
            Some(_) => {
                let silent = self.writers.iter().filter(|(_, heard)| heard.is_silent(now));
                let silent = silent.map(|(writer, _)| (*writer, Trial::default())).collect();
                self.second = Some(Second { number, opened: now, silent });
            }
        }
        number
    }

    /// Forgets readers and writers, before a new connection.
    pub fn reset(&mut self) {
        let last_number = self.last_number;
        *self = Arrivals { last_number, ..Arrivals::default() };
    }

    /// Notes a sample of a reader. Returns whether it is new: both readers deliver the samples of a writer that goes on.
    pub fn take(&mut self, reader: u64, writer: Writer, sequence: i64, now: Instant) -> bool {
        let is_first = self.first == Some(reader);
        let known = self.writers.get(&writer).copied();
        let is_new = self.second.is_none() || known.is_none_or(|heard| sequence > heard.sequence);
        if let Some(trial) = self.second.as_mut().and_then(|second| second.silent.get_mut(&writer)) {
            if is_first {
                trial.first_delivers = true;
            } else if is_new {
                trial.leads_since.get_or_insert(now);
            }
        }
        if is_new {
            self.note(writer, known, sequence, now);
        }
        is_new
    }

    fn note(&mut self, writer: Writer, known: Option<Heard>, sequence: i64, now: Instant) {
        let heard = match known {
            None if self.writers.len() >= MOST_WRITERS => return,
            None => Heard { sequence, at: now, samples: 1, interval: Duration::ZERO },
            Some(known) => {
                let interval = now.saturating_duration_since(known.at);
                self.steady = if known.is_silent(now) { 0 } else { self.steady.saturating_add(1) };
                // A silence is not an interval: what comes after it begins anew.
                let interval = if known.is_silent(now) { known.interval } else { interval };
                let interval = interval.max(known.interval - known.interval / 8);
                Heard { sequence, at: now, samples: known.samples.saturating_add(1), interval }
            }
        };
        self.writers.insert(writer, heard);
        if self.steady >= STEADY {
            self.pause = PAUSES[0];
            self.quiet_until = None;
        }
    }

    /// The next step. `present` gives the writers on the graph; it is asked only if one has fallen silent.
    pub fn tend(&mut self, now: Instant, present: impl FnOnce() -> BTreeSet<Writer>) -> Step {
        if let Some(second) = &self.second {
            return self.judge(now, second.number);
        }
        if self.first.is_none() || self.quiet_until.is_some_and(|time| now < time) {
            return Step::Wait;
        }
        if !self.writers.values().any(|heard| heard.is_silent(now)) {
            return Step::Wait;
        }
        let present = present();
        self.writers.retain(|writer, heard| present.contains(writer) || !heard.is_silent(now));
        if self.writers.values().any(|heard| heard.is_silent(now)) { Step::Open } else { Step::Wait }
    }

    /// What the trial of the second reader has shown.
    fn judge(&mut self, now: Instant, number: u64) -> Step {
        let Some(second) = &self.second else { return Step::Wait };
        if second.silent.values().any(|trial| trial.is_proof(now)) {
            let deaf = self.first.replace(number);
            self.second = None;
            (self.pause, self.quiet_until) = (PAUSES[0], None);
            return deaf.map_or(Step::Wait, Step::Replace);
        }
        let is_refuted = second.silent.values().all(|trial| trial.first_delivers);
        if is_refuted || now.saturating_duration_since(second.opened) >= TRIAL {
            self.second = None;
            self.quiet_until = Some(now + self.pause);
            self.pause = (2 * self.pause).min(PAUSES[1]);
            return Step::Close(number);
        }
        Step::Wait
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WRITER: Writer = [7; 16];
    const PERIOD: Duration = Duration::from_millis(10);

    fn present() -> BTreeSet<Writer> {
        BTreeSet::from([WRITER])
    }

    /// A stream of 100 Hz that one reader delivers; the time of its last sample.
    fn steady(arrivals: &mut Arrivals, from: Instant, samples: i64) -> (u64, Instant) {
        let reader = arrivals.enter(from);
        let mut now = from;
        for sequence in 1..=samples {
            now += PERIOD;
            assert!(arrivals.take(reader, WRITER, sequence, now));
            assert_eq!(arrivals.tend(now, present), Step::Wait);
        }
        (reader, now)
    }

    #[test]
    fn a_deaf_reader_is_replaced_and_no_sample_is_delivered_twice() {
        let mut arrivals = Arrivals::default();
        let (first, now) = steady(&mut arrivals, Instant::now(), 100);
        assert_eq!(arrivals.tend(now + SHORTEST, present), Step::Wait);
        let now = now + SHORTEST + PERIOD;
        assert_eq!(arrivals.tend(now, present), Step::Open);
        let second = arrivals.enter(now);
        assert!(!arrivals.take(second, WRITER, 100, now), "a latched sample comes again");
        assert!(arrivals.take(second, WRITER, 220, now));
        assert_eq!(arrivals.tend(now + LEAD / 2, present), Step::Wait);
        assert_eq!(arrivals.tend(now + LEAD, present), Step::Replace(first));
        assert!(arrivals.take(second, WRITER, 221, now + LEAD));
        assert_eq!(arrivals.tend(now + LEAD, present), Step::Wait);
    }

    #[test]
    fn a_writer_that_pauses_keeps_its_reader_and_trials_become_rare() {
        let mut arrivals = Arrivals::default();
        let (first, mut now) = steady(&mut arrivals, Instant::now(), 100);
        let mut trials = 0;
        let end = now + Duration::from_secs(3600);
        while now < end {
            match arrivals.tend(now, present) {
                Step::Open => {
                    trials += 1;
                    arrivals.enter(now);
                }
                Step::Replace(reader) => assert_eq!(reader, 0, "nobody was deaf"),
                Step::Wait | Step::Close(_) => {}
            }
            now += Duration::from_millis(250);
        }
        assert!((10..20).contains(&trials), "{trials} trials in an hour");
        assert_eq!(arrivals.first, Some(first));
    }

    #[test]
    fn a_writer_that_goes_on_is_no_proof_against_the_first_reader() {
        let mut arrivals = Arrivals::default();
        let (first, now) = steady(&mut arrivals, Instant::now(), 100);
        let now = now + 2 * SHORTEST;
        assert_eq!(arrivals.tend(now, present), Step::Open);
        let second = arrivals.enter(now);
        assert!(arrivals.take(second, WRITER, 101, now));
        assert!(!arrivals.take(first, WRITER, 101, now + PERIOD));
        assert_eq!(arrivals.tend(now + LEAD, present), Step::Close(second));
    }

    #[test]
    fn a_reader_that_is_deaf_to_one_of_two_writers_is_replaced() {
        let mut arrivals = Arrivals::default();
        let other: Writer = [8; 16];
        let (first, mut now) = steady(&mut arrivals, Instant::now(), 100);
        let mut sequence = 0;
        let end = now + 2 * SHORTEST;
        while now < end {
            now += PERIOD;
            sequence += 1;
            arrivals.take(first, other, sequence, now);
        }
        assert_eq!(arrivals.tend(now, || BTreeSet::from([WRITER, other])), Step::Open);
        let second = arrivals.enter(now);
        arrivals.take(first, other, sequence + 1, now);
        assert!(arrivals.take(second, WRITER, 300, now));
        assert_eq!(arrivals.tend(now + LEAD, present), Step::Replace(first));
    }

    #[test]
    fn a_writer_that_left_is_not_waited_for() {
        let mut arrivals = Arrivals::default();
        let (_, now) = steady(&mut arrivals, Instant::now(), 100);
        assert_eq!(arrivals.tend(now + 2 * SHORTEST, BTreeSet::new), Step::Wait);
        assert!(arrivals.writers.is_empty());
    }

    #[test]
    fn a_slow_writer_has_five_of_its_intervals() {
        let mut arrivals = Arrivals::default();
        let reader = arrivals.enter(Instant::now());
        let (mut now, second) = (Instant::now(), Duration::from_secs(1));
        for sequence in 1..=20 {
            now += second;
            arrivals.take(reader, WRITER, sequence, now);
        }
        assert_eq!(arrivals.tend(now + 5 * second, present), Step::Wait);
        assert_eq!(arrivals.tend(now + 5 * second + PERIOD, present), Step::Open);
    }
}
