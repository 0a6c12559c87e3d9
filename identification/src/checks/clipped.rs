//! Finds pressures that exceed the range of their sensor.

use super::runs::{Run, runs};

/// Fewest samples at the largest value that form a plateau.
const PLATEAU: usize = 10;

/// A plateau must be this many times longer than any other run of one value: a coarsely quantised signal has such runs
/// everywhere.
const LONGER: usize = 5;

/// Fewest plateaus: a single one may be a rest.
const PLATEAUS: usize = 2;

/// A clipped signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cut {
    /// Its largest value.
    pub value: f64,
    /// Longest time at that value, s.
    pub longest: f64,
    /// Share of the samples at that value.
    pub share: f64,
}

/// Finds a signal that is clipped at its largest value. The smallest value is not examined, because pressures do rest at zero.
pub(super) fn clipped(time: &[f64], signal: &[f64]) -> Option<Cut> {
    let all = runs(signal);
    let value = all.iter().map(|run| run.value).fold(f64::NEG_INFINITY, f64::max);
    let (at_top, others): (Vec<&Run>, Vec<&Run>) = all.iter().partition(|run| run.value == value);
    let other = others.iter().map(|run| run.len()).max()?;
    let least = PLATEAU.max(LONGER * other);
    // A plateau at the start or end of the recording has no visible rise or fall.
    let inner = at_top.iter().filter(|run| run.first > 0 && run.last + 1 < signal.len() && run.len() >= least);
    if inner.count() < PLATEAUS {
        return None;
    }
    let longest = at_top.iter().map(|run| time[run.last] - time[run.first]).fold(0.0, f64::max);
    let samples: usize = at_top.iter().map(|run| run.len()).sum();
    Some(Cut { value, longest, share: samples as f64 / signal.len() as f64 })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::clipped;

    #[test]
    fn peaks_that_are_cut_off_are_found_and_round_ones_are_not() {
        let time: Vec<f64> = (0..1000).map(|index| index as f64 * 0.01).collect();
        let round: Vec<f64> = time.iter().map(|t| 1e6 * (2.0 + (2.0 * t).sin())).collect();
        assert_eq!(clipped(&time, &round), None);
        let cut: Vec<f64> = round.iter().map(|value| value.min(2.8e6)).collect();
        let found = clipped(&time, &cut).unwrap();
        assert_eq!(found.value, 2.8e6);
        assert!(found.longest > 0.3 && found.share > 0.1);
        // Steps of 0.2 MPa: every value is held for a while.
        let coarse: Vec<f64> = round.iter().map(|value| (value / 2e5).round() * 2e5).collect();
        assert_eq!(clipped(&time, &coarse), None);
    }
}
