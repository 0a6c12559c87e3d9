//! Finds runs of identical values in a signal.

/// Consecutive samples with exactly the same value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    /// Index of the first sample.
    pub first: usize,
    /// Index of the last sample.
    pub last: usize,
    /// Their value.
    pub value: f64,
}

impl Run {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.last + 1 - self.first
    }
}

/// All runs of a signal, in order; unmeasured samples belong to none.
pub(super) fn runs(signal: &[f64]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (index, &value) in signal.iter().enumerate().filter(|(_, value)| value.is_finite()) {
        match runs.last_mut() {
            Some(run) if run.last + 1 == index && run.value == value => run.last = index,
            _ => runs.push(Run { first: index, last: index, value }),
        }
    }
    runs
}

/// Smallest and largest measured value; (infinity, -infinity) if there is none.
pub(super) fn range(signal: &[f64]) -> (f64, f64) {
    let finite = signal.iter().filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)))
}

/// Largest minus smallest value; zero if nothing is measured.
pub(super) fn spread(signal: &[f64]) -> f64 {
    let (low, high) = range(signal);
    (high - low).max(0.0)
}
