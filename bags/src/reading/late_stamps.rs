//! Detects stamps that are earlier than a previous one.

/// Minimum number of consecutive rising stamps, all earlier than a previous stamp, that is a clock step. Fewer are late
/// messages: a network reorders a few.
const FEWEST_OF_A_STEP: usize = 20;

/// The number of stamps that are smaller than a previous one.
pub(crate) fn count_late(stamps: &[i64]) -> u64 {
    let mut latest = i64::MIN;
    let mut late = 0;
    for &stamp in stamps {
        late += u64::from(stamp < latest);
        latest = latest.max(stamp);
    }
    late
}

/// One line for each time that the clock (stamps in ns) was set back. Until the clock reaches its previous value, two
/// moments of the machine have the same time; a recording that is sorted by time mixes them.
pub(crate) fn steps_back(stamps: &[i64]) -> Vec<String> {
    let start = stamps.iter().min().copied().unwrap_or_default();
    let seconds = |stamp: i64| stamp.saturating_sub(start) as f64 / 1e9;
    let mut lines = Vec::new();
    let mut latest = i64::MIN;
    let mut first = 0;
    while first < stamps.len() {
        if stamps[first] >= latest {
            latest = stamps[first];
            first += 1;
            continue;
        }
        let rest = &stamps[first..];
        let rising = 1 + rest.windows(2).take_while(|pair| pair[0] < pair[1] && pair[1] < latest).count();
        if rising >= FEWEST_OF_A_STEP {
            let (from, to) = (seconds(rest[0]), seconds(latest));
            lines.push(format!(
                "the clock was set back by {:.3} s at {to:.3} s: from {from:.3} s to there two moments of the machine have each time; \
                 leave that time out (BAG@FROM..TO)",
                to - from
            ));
        }
        first += rising;
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::{count_late, steps_back};

    #[test]
    fn a_clock_that_is_set_back_is_told_and_late_messages_are_not() {
        let milliseconds = |from: i64, to: i64| (from..to).map(|stamp| stamp * 1_000_000);
        let even: Vec<i64> = milliseconds(0, 1000).collect();
        assert!(steps_back(&even).is_empty());
        let mut late = even.clone();
        late.swap(100, 102);
        late.swap(500, 515);
        assert!(count_late(&late) > 0 && steps_back(&late).is_empty());
        let back: Vec<i64> = milliseconds(0, 1000).chain(milliseconds(600, 2000)).collect();
        assert_eq!(count_late(&back), 399);
        let lines = steps_back(&back);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].contains("set back by 0.399 s at 0.999 s: from 0.600 s"), "{}", lines[0]);
        // A table in reverse order has no such step.
        let reversed: Vec<i64> = even.iter().rev().copied().collect();
        assert!(steps_back(&reversed).is_empty());
    }
}
