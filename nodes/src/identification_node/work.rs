//! The work itself, without ROS.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use excavator_identification::fit::{FitError, FitSettings};
use excavator_identification::fitted_along::{IN_REGRESSION, fit_with_effects_along, with_effects_along};
use excavator_identification::regression::{RegressionError, WeakFormSettings, weak_form_watched};
use excavator_identification::validation::compare;
use excavator_model::document::{parse, to_text};
use excavator_model::recording::Recording;
use excavator_model::{HistoryEntry, Model};

use super::types::{Goal, Outcome};
use crate::cli::Mapping;
use crate::error::VerbError;
use crate::sources;

/// Why there is no outcome.
#[derive(Debug)]
pub(super) enum Ended {
    /// Nobody wants it any more.
    Cancelled,
    /// It failed.
    Failed(VerbError),
}

impl<E: Into<VerbError>> From<E> for Ended {
    fn from(error: E) -> Self {
        match error.into() {
            VerbError::Fit(FitError::Stopped) | VerbError::Regression(RegressionError::Fit(FitError::Stopped)) => {
                Ended::Cancelled
            }
            error => Ended::Failed(error),
        }
    }
}

/// Does what the goal asks for; `tell` hears of stage and progress, `cancelled` is looked at between the stages and
/// between the rounds of the long ones.
pub(super) fn identify(goal: &Goal, cancelled: &AtomicBool, tell: &dyn Fn(&str, f64)) -> Result<Outcome, Ended> {
    let stage = |name: &str, progress: f64| {
        if cancelled.load(Ordering::Relaxed) {
            return Err(Ended::Cancelled);
        }
        tell(name, progress);
        Ok(())
    };
    stage("reading the model", 0.0)?;
    let given = model(&goal.model)?;
    let mut wanted = given.clone();
    for effect in &goal.effects {
        for (physics, site) in wanted.parse_addition(effect)? {
            wanted = wanted.with_effect(physics, site)?;
        }
    }
    if goal.bags.is_empty() {
        return Err(VerbError::NoBags.into());
    }
    let mut recordings = Vec::new();
    for (index, bag) in goal.bags.iter().enumerate() {
        stage("reading", 0.3 * index as f64 / goal.bags.len() as f64)?;
        recordings.push(sources::recording(&PathBuf::from(bag), &Mapping { map: None }, &wanted)?);
    }
    let recordings: Vec<&Recording> = recordings.iter().collect();
    let part = |name: &'static str, from: f64, to: f64| {
        move |done: f64| match stage(name, from + (to - from) * done) {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    };
    let settings = WeakFormSettings::default();
    let plain = weak_form_watched(&wanted, &recordings, &settings, &part("identifying", 0.3, 0.45))?;
    let timing = part("identifying with the sensors' timing", 0.45, 0.45);
    let anew = |model: &Model| weak_form_watched(model, &recordings, &settings, &timing).ok();
    let mut identified = with_effects_along(
        plain,
        IN_REGRESSION,
        wanted.effects.len(),
        &recordings,
        |solved| &solved.model,
        anew,
        |_| false,
    )
    .model;
    if !goal.effects.is_empty() {
        // Effects that were added start far from their values, and some enter nonlinearly: outputs are fitted too.
        let fitting = part("fitting outputs", 0.5, 0.7);
        identified = fit_with_effects_along(&identified, &recordings, &FitSettings::default(), &fitting)?.model;
    }
    let (mut signals, mut before, mut after) = (Vec::new(), Vec::new(), Vec::new());
    for (index, recording) in recordings.iter().enumerate() {
        stage("comparing", 0.7 + 0.3 * index as f64 / recordings.len() as f64)?;
        let share = 1.0 / recordings.len() as f64;
        let pairs = compare(&given, recording)?.signals.into_iter().zip(compare(&identified, recording)?.signals);
        for (number, (old, new)) in pairs.enumerate() {
            if index == 0 {
                signals.push(old.name);
                before.push(0.0);
                after.push(0.0);
            }
            if let (Some(before), Some(after)) = (before.get_mut(number), after.get_mut(number)) {
                *before += share * old.normalised_error;
                *after += share * new.normalised_error;
            }
        }
    }
    stage("done", 1.0)?;
    let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len().max(1) as f64;
    let message = format!(
        "{} identified from {} bags: mean NMSE {:.4} before, {:.4} after",
        identified.machine.name,
        recordings.len(),
        mean(&before),
        mean(&after)
    );
    identified.history.push(HistoryEntry {
        when: jiff::Timestamp::now().to_string(),
        what: "parameters identified (weak form with instruments)".to_string(),
        recordings: goal.bags.clone(),
        validation_error_before: None,
        validation_error_after: None,
    });
    let model = to_text(&identified)?;
    Ok(Outcome { model, signals, nmse_before: before, nmse_after: after, success: true, message })
}

/// A model file, a built-in name, or the text of a model.
fn model(text: &str) -> Result<Model, VerbError> {
    if text.contains('\n') && !Path::new(text).exists() {
        return Ok(parse("the model of the goal", text)?);
    }
    sources::model(text)
}

#[cfg(test)]
mod tests {
    use std::cell::{Cell, RefCell};

    use super::*;

    fn goal() -> Goal {
        Goal {
            model: "zx30u-arm".to_string(),
            bags: vec![concat!(env!("CARGO_MANIFEST_DIR"), "/../bags/samples/arm-swing").to_string()],
            effects: vec!["entrained_air".to_string()],
        }
    }

    #[test]
    fn stages_are_told_in_order_and_the_long_ones_step_by_step() {
        let told: RefCell<Vec<(String, f64)>> = RefCell::default();
        let tell = |stage: &str, done: f64| told.borrow_mut().push((stage.to_string(), done));
        let outcome = identify(&goal(), &AtomicBool::new(false), &tell);
        assert!(outcome.is_ok(), "{outcome:?}");
        let told = told.into_inner();
        assert!(told.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{told:?}");
        assert!(told.iter().filter(|(stage, _)| stage == "fitting outputs").count() > 2, "{told:?}");
    }

    #[test]
    fn cancelled_work_ends_within_the_stage() {
        for (stage, rounds) in [("identifying", 2), ("fitting outputs", 2)] {
            let cancelled = AtomicBool::new(false);
            let seen = Cell::new(0);
            let tell = |name: &str, _: f64| {
                assert!(!cancelled.load(Ordering::Relaxed), "{name} goes on after {stage} was cancelled");
                seen.set(seen.get() + usize::from(name == stage));
                cancelled.store(seen.get() == rounds, Ordering::Relaxed);
            };
            let ended = identify(&goal(), &cancelled, &tell);
            assert!(matches!(ended, Err(Ended::Cancelled)), "{stage}: {ended:?}");
            assert_eq!(seen.get(), rounds);
        }
    }
}
