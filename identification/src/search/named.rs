//! Scores of effects that the user named.

use excavator_model::recording::Recording;

use super::pool::Pool;
use super::transient::evaluate_on_others;
use super::{Addition, AdditionError, Effort, Trial};
use crate::decision::{Policy, Scores};
use crate::fit::{Fit, FitSettings};

/// Scores of `given` and of the models that result from adding `added` one after the other.
///
/// # Errors
/// [`AdditionError`] if a model cannot be evaluated on the validation recordings.
pub(crate) fn score_named(
    given: &Fit,
    added: &[(Addition, Fit)],
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &FitSettings,
    policy: &Policy,
) -> Result<Scores, AdditionError> {
    let first = Trial::given(given.clone(), validation, settings)?;
    let mut known = first.validation.model.clone();
    // Its values before the fit do not matter here: nothing is chosen.
    let mut pool = Pool::new(&given.model, first, identification, validation);
    pool.look_at_inputs(&Effort { fit: *settings, ..Effort::default() }, policy);
    let mut additions = Vec::new();
    for (addition, fit) in added {
        additions.push(addition.clone());
        let evaluated = evaluate_on_others(&fit.model, &known, validation, settings)?;
        known = evaluated.model.clone();
        let additions = additions.clone();
        pool.put(Trial { additions, fit: fit.clone(), validation: evaluated, seconds: 0.0, error: None });
    }
    Ok(pool.scores)
}
