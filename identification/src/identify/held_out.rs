//! Chooses the method that predicts best.

use std::ops::ControlFlow;

use excavator_model::Model;
use excavator_model::recording::Recording;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Identified, IdentifyError, Method, identify_watched};
use crate::fit::{FitError, Watch};
use crate::regression::RegressionError;
use crate::validation::mean_error;

/// How well a method predicts what it has not seen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct HeldOut {
    /// The method.
    pub method: Method,
    /// Mean NMSE on the last third of each recording, with parameters from the rest; `null` if the method fails or its model cannot be
    /// simulated there.
    pub nmse: Option<f64>,
}

/// The methods that are compared, the one with the best founded intervals first.
const METHODS: [Method; 3] = [Method::WeakForm, Method::OutputError, Method::SimulationError];

/// Share of each recording that the parameters are taken from while methods are compared.
const SEEN: f64 = 2.0 / 3.0;

/// The first method that works is left for one whose error is less than this share of its own. The weak form has no bias from what the
/// model lacks between the equations, and an output error uses all that the recordings tell, so a little more error is no reason.
const CLEARLY_BETTER: f64 = 0.8;

/// Identifies with the method that predicts the last third of each recording best.
///
/// # Errors
/// [`IdentifyError`] of the method that is chosen.
pub(super) fn best(model: &Model, recordings: &[&Recording], watch: Watch<'_>) -> Result<Identified, IdentifyError> {
    let parts: Vec<[Recording; 2]> = recordings.iter().map(|recording| split(recording)).collect();
    let [seen, unseen] = [0, 1].map(|part| parts.iter().map(|parts| &parts[part]).collect::<Vec<_>>());
    let total = METHODS.len() as f64 + 1.0;
    let mut held_out = Vec::new();
    for (number, method) in METHODS.into_iter().enumerate() {
        let found = identify_watched(model, &seen, method, &|done| watch((number as f64 + done) / total));
        if let Err(
            IdentifyError::Fit(FitError::Stopped) | IdentifyError::Regression(RegressionError::Fit(FitError::Stopped)),
        ) = found
        {
            return Err(FitError::Stopped.into());
        }
        let nmse = found.ok().and_then(|found| mean_error(&found.model, &unseen).ok()).filter(|nmse| nmse.is_finite());
        held_out.push(HeldOut { method, nmse });
    }
    let last = |done: f64| match done {
        done if done < 1.0 => watch((METHODS.len() as f64 + done) / total),
        _ => ControlFlow::Continue(()),
    };
    let mut identified = identify_watched(model, recordings, chosen(&held_out), &last)?;
    identified.held_out = held_out;
    Ok(identified)
}

/// The method with the least error, if that is clearly less than the error of the first method that works; else that one.
fn chosen(held_out: &[HeldOut]) -> Method {
    let error = |one: &HeldOut| one.nmse.unwrap_or(f64::INFINITY);
    let Some(first) = held_out.iter().find(|one| one.nmse.is_some()) else { return Method::WeakForm };
    let best = held_out.iter().min_by(|a, b| error(a).total_cmp(&error(b)));
    best.filter(|best| error(best) < CLEARLY_BETTER * error(first)).unwrap_or(first).method
}

/// The part that the parameters are taken from, and the rest.
fn split(recording: &Recording) -> [Recording; 2] {
    let (first, last) = (recording.time.first().copied().unwrap_or(0.0), recording.time.last().copied().unwrap_or(0.0));
    let border = first + SEEN * (last - first);
    [recording.part(first, border), recording.part(border, last)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weak_form_is_left_for_a_clearly_better_method_only() {
        let of = |errors: [Option<f64>; 3]| {
            let each = METHODS.into_iter().zip(errors);
            chosen(&each.map(|(method, nmse)| HeldOut { method, nmse }).collect::<Vec<_>>())
        };
        assert_eq!(of([Some(0.1), Some(0.09), Some(0.085)]), Method::WeakForm);
        assert_eq!(of([Some(0.1), Some(0.09), Some(0.05)]), Method::SimulationError);
        assert_eq!(of([Some(0.1), Some(0.04), Some(0.05)]), Method::OutputError);
        assert_eq!(of([None, Some(0.74), Some(0.64)]), Method::OutputError);
        assert_eq!(of([None, None, Some(2.0)]), Method::SimulationError);
        assert_eq!(of([None; 3]), Method::WeakForm);
    }
}
