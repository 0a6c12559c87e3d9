//! The channels through which the values of one signal came: each publisher that a recorder tells apart has its own.

/// Share of the time of the shorter one of two channels in which both were written, from which they are two publishers.
/// A publisher that starts anew follows the one before.
const LEAST_OVERLAP: f64 = 0.1;

/// Values of one signal from each channel of its topic.
#[derive(Debug, Clone, Default)]
pub(super) struct Channels {
    seen: Vec<Channel>,
    /// Numbers of channels whose values are not used.
    pub left_out: Vec<usize>,
}

/// One channel, numbered in the order of the bag.
#[derive(Debug, Clone, Copy)]
struct Channel {
    number: usize,
    values: u64,
    /// Log times of its first and last value, ns.
    first: i64,
    last: i64,
}

/// A channel with fewer values than another one of the same time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Beside {
    pub number: usize,
    pub values: u64,
    /// Values of the other one.
    pub values_of_other: u64,
}

impl Channels {
    /// Adds a value that came through channel `number`.
    pub fn note(&mut self, number: usize, log: i64) {
        match self.seen.iter_mut().rev().find(|channel| channel.number == number) {
            Some(channel) => {
                channel.values += 1;
                (channel.first, channel.last) = (channel.first.min(log), channel.last.max(log));
            }
            None => self.seen.push(Channel { number, values: 1, first: log, last: log }),
        }
    }

    /// The channels that another one with more values overlaps.
    pub fn beside_others(&self) -> Vec<Beside> {
        let mut by_values = self.seen.clone();
        by_values.sort_by_key(|channel| (std::cmp::Reverse(channel.values), channel.number));
        let (mut used, mut beside): (Vec<Channel>, Vec<Beside>) = (Vec::new(), Vec::new());
        for channel in by_values {
            match used.iter().find(|other| overlap(&channel, other)) {
                Some(other) => {
                    let Channel { number, values, .. } = channel;
                    beside.push(Beside { number, values, values_of_other: other.values });
                }
                None => used.push(channel),
            }
        }
        beside
    }
}

fn overlap(one: &Channel, other: &Channel) -> bool {
    let common = one.last.min(other.last).saturating_sub(one.first.max(other.first));
    let shorter = one.last.saturating_sub(one.first).min(other.last.saturating_sub(other.first));
    // One value alone has no length: it is within the other one or not.
    if shorter == 0 { common >= 0 && one.last != other.first } else { common as f64 > LEAST_OVERLAP * shorter as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channels(ranges: &[(i64, i64, i64)]) -> Channels {
        let mut channels = Channels::default();
        for (number, &(first, last, step)) in ranges.iter().enumerate() {
            (first..=last).step_by(step as usize).for_each(|log| channels.note(number, log));
        }
        channels
    }

    #[test]
    fn the_channel_with_more_values_of_the_same_time_is_used() {
        let beside = channels(&[(0, 1000, 50), (0, 1000, 1)]).beside_others();
        assert_eq!(beside, [Beside { number: 0, values: 21, values_of_other: 1001 }]);
        // Two files of a split bag, each with two publishers.
        let numbers = |channels: Channels| channels.beside_others().iter().map(|b| b.number).collect::<Vec<_>>();
        assert_eq!(numbers(channels(&[(0, 500, 1), (0, 500, 9), (501, 900, 1), (501, 900, 9)])), [1, 3]);
    }

    #[test]
    fn a_publisher_that_starts_anew_is_no_second_one() {
        assert!(channels(&[(0, 500, 1), (501, 900, 1), (899, 2000, 1)]).beside_others().is_empty());
        assert!(channels(&[(0, 0, 1), (0, 0, 1)]).beside_others().is_empty());
    }
}
