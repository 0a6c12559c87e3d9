//! Times as numbers of days, as spreadsheets and MATLAB have them.

/// Numbers of days of a spreadsheet from 1954 to 2119, and of MATLAB from 1915 to 2190.
const SPREADSHEET: std::ops::Range<f64> = 20_000.0..80_000.0;
const MATLAB: std::ops::Range<f64> = 700_000.0..800_000.0;
/// Day 0 of 1970 in both.
const SPREADSHEET_EPOCH: f64 = 25_569.0;
const MATLAB_EPOCH: f64 = 719_529.0;
/// Longest step between rows, days: 1.7 s. As seconds, it would be 50 kHz, hours after the start.
const LONGEST_STEP: f64 = 2e-5;

/// Longest step between times of day, days: 86 ms. As seconds, it would be 1 MHz.
const LONGEST_STEP_OF_DAY: f64 = 1e-6;

/// Whether numbers without a unit can only be days: they are in the range of dates or within a day, and their steps would be absurd as
/// seconds.
pub(super) fn are_days(times: &[f64]) -> bool {
    let first = times.iter().copied().find(|time| time.is_finite());
    let longest = match first {
        Some(first) if SPREADSHEET.contains(&first) || MATLAB.contains(&first) => LONGEST_STEP,
        // A time of day; from zero on, it may be anything.
        Some(first) if first > 0.0 && first < 1.0 => LONGEST_STEP_OF_DAY,
        _ => return false,
    };
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
    let Some(middle) = steps.len().checked_sub(1).map(|last| last / 2) else { return false };
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1 < longest
}

/// The number of 1 January 1970, if a number of days is a date.
pub(super) fn epoch(first: f64) -> Option<f64> {
    match first {
        first if SPREADSHEET.contains(&first) => Some(SPREADSHEET_EPOCH),
        first if MATLAB.contains(&first) => Some(MATLAB_EPOCH),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(first: f64, step: f64) -> Vec<f64> {
        (0..100).map(|row| first + step * f64::from(row)).collect()
    }

    #[test]
    fn days_are_known_by_their_steps() {
        let millisecond = 1.0 / 86_400_000.0;
        for first in [45_250.43, 739_210.43] {
            assert!(are_days(&rows(first, 2.0 * millisecond)) && are_days(&rows(first, 1000.0 * millisecond)));
            assert!(!are_days(&rows(first, 0.002)));
            // 20 November 2023.
            assert_eq!(epoch(first).map(|epoch| (first - epoch).floor()), Some(19_681.0));
        }
        assert!(are_days(&rows(0.417, 2.0 * millisecond)) && !are_days(&rows(0.417, 1e-5)));
        assert!(!are_days(&rows(0.0, millisecond)) && !are_days(&[45_250.0]) && !are_days(&[]));
        assert_eq!(epoch(0.5), None);
    }
}
