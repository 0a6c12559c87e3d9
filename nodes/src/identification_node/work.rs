//! The work itself, without ROS.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use excavator_identification::fit::{FitSettings, fit};
use excavator_identification::regression::{WeakFormSettings, weak_form};
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
        Ended::Failed(error.into())
    }
}

/// Does what the goal asks for; `tell` hears of stage and progress, `cancelled` is looked at between the stages.
pub(super) fn identify(goal: &Goal, cancelled: &AtomicBool, tell: &mut dyn FnMut(&str, f64)) -> Result<Outcome, Ended> {
    let mut stage = |name: &str, progress: f64| {
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
    stage("identifying", 0.3)?;
    let mut identified = weak_form(&wanted, &recordings, &WeakFormSettings::default())?.model;
    if !goal.effects.is_empty() {
        // Effects that were added start far from their values, and some enter nonlinearly: outputs are fitted too.
        stage("fitting outputs", 0.5)?;
        identified = fit(&identified, &recordings, &FitSettings::default())?.model;
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
