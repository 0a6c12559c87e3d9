//! Whether parameters drift over recordings: the first half of each against its second half.

use excavator_model::recording::Recording;

use super::changes::{Changes, between};
use crate::fit::{Fit, FitError, FitSettings};

/// Compares the first halves of `recordings` with their second halves, from a fit of the same model to some of them.
///
/// # Errors
/// [`FitError`] if a half does not suffice for a fit.
pub fn drift(fitted: &Fit, recordings: &[&Recording], settings: &FitSettings) -> Result<Changes, FitError> {
    let half = |from: f64, to: f64| -> Vec<Recording> {
        let part = |recording: &&Recording| {
            let (start, duration) = (recording.time.first().copied().unwrap_or(0.0), recording.duration());
            recording.part(start + from * duration, start + to * duration)
        };
        recordings.iter().map(part).collect()
    };
    let (begin, end) = (half(0.0, 0.5), half(0.5, 1.0));
    between(fitted, &begin.iter().collect::<Vec<_>>(), &end.iter().collect::<Vec<_>>(), settings)
}
