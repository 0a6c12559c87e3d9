//! The identification of one goal, without ROS.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use excavator_identification::fit::FitError;
use excavator_identification::identify::{IdentifyError, Method};
use excavator_identification::regression::RegressionError;
use excavator_identification::validation::{Comparison, compare, errors_of, mean_error_of};
use excavator_model::document::to_text;
use excavator_model::recording::Recording;
use excavator_model::{HistoryEntry, Model, addition_name, site_name};
use excavator_study::preparation::Preparation;
use excavator_study::{Study, WorkError};

use super::library::{Library, QUOTED, Unusable};
use super::printable::printable;
use super::refusals::{remark, tell_operator};
use super::types::{Goal, Outcome};

/// Why there is no outcome.
#[derive(Debug)]
pub(super) enum Ended {
    /// The goal was cancelled.
    Cancelled,
    /// The goal exceeded its time limit.
    TimedOut,
    /// A model or bag of the goal cannot be used.
    Unusable(Unusable),
    /// The identification failed.
    Failed(WorkError),
}

impl From<Unusable> for Ended {
    fn from(unusable: Unusable) -> Self {
        Ended::Unusable(unusable)
    }
}

/// The message for a goal that exceeded its time limit.
pub(super) fn out_of_time(limit: Duration) -> String {
    format!(
        "not done within {:.0} s; give fewer or shorter recordings, or start the node with a longer time_limit",
        limit.as_secs_f64()
    )
}

/// Limits of the work on a goal.
pub(super) struct Bounds<'b> {
    /// The models and bags that goals may use.
    pub library: &'b Library,
    /// Set when the goal is cancelled.
    pub cancelled: &'b AtomicBool,
    /// Latest end of the work.
    pub deadline: Instant,
}

impl Bounds<'_> {
    fn check(&self) -> Result<(), Ended> {
        if self.cancelled.load(Ordering::Relaxed) {
            return Err(Ended::Cancelled);
        }
        if Instant::now() >= self.deadline { Err(Ended::TimedOut) } else { Ok(()) }
    }
}

impl From<WorkError> for Ended {
    fn from(error: WorkError) -> Self {
        match error {
            WorkError::Identify(
                IdentifyError::Fit(FitError::Stopped)
                | IdentifyError::Regression(RegressionError::Fit(FitError::Stopped)),
            ) => Ended::Cancelled,
            error => Ended::Failed(error),
        }
    }
}

/// Executes a goal. `tell` receives the stage and the progress. The limits are checked between the stages, and between the
/// rounds of the long ones.
pub(super) fn identify(goal: &Goal, bounds: &Bounds<'_>, tell: &dyn Fn(&str, f64)) -> Result<Outcome, Ended> {
    identify_within(goal, bounds, tell).map_err(|ended| match ended {
        // A stopped computation does not report why it was stopped.
        Ended::Cancelled => bounds.check().err().unwrap_or(Ended::Cancelled),
        ended => ended,
    })
}

fn identify_within(goal: &Goal, bounds: &Bounds<'_>, tell: &dyn Fn(&str, f64)) -> Result<Outcome, Ended> {
    let stage = |name: &str, progress: f64| {
        bounds.check()?;
        tell(name, progress);
        Ok::<(), Ended>(())
    };
    stage("reading the model", 0.0)?;
    let given = bounds.library.model(&goal.model)?;
    let wanted = with_effects(&given, &goal.effects)?;
    if goal.bags.is_empty() {
        return Err(Unusable::NoBags.into());
    }
    let mut recordings = Vec::new();
    for (index, bag) in goal.bags.iter().enumerate() {
        stage("reading", 0.3 * index as f64 / goal.bags.len() as f64)?;
        recordings.push(recording(bag, bounds.library, &wanted)?);
    }
    // Added effects start far from their values, and some enter nonlinearly. So the outputs are fitted as well.
    let method = if goal.effects.is_empty() { Method::Best } else { Method::OutputError };
    let watch = |done: f64| match stage("identifying", 0.3 + 0.4 * done) {
        Ok(()) => ControlFlow::Continue(()),
        Err(_) => ControlFlow::Break(()),
    };
    let study = Study::of_fitted(wanted, recordings);
    let identified = study.identify(method, &watch)?.result.model;
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for (index, recording) in study.identification.iter().enumerate() {
        stage("comparing", 0.7 + 0.3 * index as f64 / study.identification.len() as f64)?;
        before.push(compare(&given, recording).map_err(WorkError::from)?);
        after.push(compare(&identified, recording).map_err(WorkError::from)?);
    }
    stage("done", 1.0)?;
    let message = format!(
        "{} identified from {} bags: mean NMSE on these bags {:.4} before, {:.4} after",
        identified.machine.name,
        study.identification.len(),
        mean_error_of(&before),
        mean_error_of(&after)
    );
    let errors = |comparisons: &[Comparison]| -> (Vec<String>, Vec<f64>) {
        errors_of(comparisons).into_iter().map(|(name, error)| (name.to_string(), error.normalised())).unzip()
    };
    let ((signals, nmse_before), (_, nmse_after)) = (errors(&before), errors(&after));
    let model = to_text(&identified).map_err(WorkError::from)?;
    Ok(Outcome { model, signals, nmse_before, nmse_after, success: true, message })
}

/// The model with the effects of a goal; its history tells that they were added.
fn with_effects(given: &Model, effects: &[String]) -> Result<Model, WorkError> {
    let mut wanted = given.clone();
    for effect in effects {
        for (physics, site) in wanted.parse_addition(effect)? {
            let name = addition_name(&physics.card().name, site_name(&wanted.machine, site));
            wanted = wanted.with_effect(&physics, site)?;
            wanted.history.push(HistoryEntry {
                when: jiff::Timestamp::now().to_string(),
                what: format!("added {name}"),
                recordings: Vec::new(),
                validation_error_before: None,
                validation_error_after: None,
            });
        }
    }
    Ok(wanted)
}

/// A bag of the library as a recording. A reader's message may quote a file, so it goes to the console only.
fn recording(name: &str, library: &Library, wanted: &Model) -> Result<Recording, Ended> {
    let path = library.bag(name)?;
    let preparation = Preparation { remark: &remark, ..Preparation::default() };
    preparation.recording(&path, wanted).map_err(|error| match error {
        WorkError::Recording(_) | WorkError::Bag(_) => {
            tell_operator(&error.to_string());
            Ended::Unusable(Unusable::NotARecording(printable(name, QUOTED)))
        }
        error => Ended::Failed(error),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::cell::{Cell, RefCell};

    use excavator_model::document::{built_in, parse};
    use excavator_model::effects::Catalogue;

    use super::*;

    fn goal() -> Goal {
        Goal {
            model: "zx30u-arm".to_string(),
            bags: vec!["arm-swing".to_string()],
            effects: vec!["entrained_air".to_string()],
        }
    }

    fn work(time: Duration, cancelled: &AtomicBool, tell: &dyn Fn(&str, f64)) -> Result<Outcome, Ended> {
        let library = Library::new("", concat!(env!("CARGO_MANIFEST_DIR"), "/../bags/samples"));
        let library = library.map_err(|reason| Ended::Unusable(Unusable::Text(reason)))?;
        identify(&goal(), &Bounds { library: &library, cancelled, deadline: Instant::now() + time }, tell)
    }

    const HOUR: Duration = Duration::from_secs(3600);

    #[test]
    fn stages_are_told_in_order_and_the_long_ones_step_by_step() {
        let told: RefCell<Vec<(String, f64)>> = RefCell::default();
        let tell = |stage: &str, done: f64| told.borrow_mut().push((stage.to_string(), done));
        let outcome = work(HOUR, &AtomicBool::new(false), &tell);
        assert!(outcome.is_ok(), "{outcome:?}");
        let told = told.into_inner();
        assert!(told.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{told:?}");
        assert!(told.iter().filter(|(stage, _)| stage == "identifying").count() > 4, "{told:?}");
    }

    /// The numbers of `excavator identify`, to the last digit, with and without an added effect.
    #[test]
    fn a_goal_is_identified_as_the_terminal_does_it() {
        let samples = concat!(env!("CARGO_MANIFEST_DIR"), "/../bags/samples");
        for effects in [vec![], vec!["valve_dead_zone@arm".to_string()]] {
            let library = Library::new("", samples).unwrap();
            let (cancelled, deadline) = (AtomicBool::new(false), Instant::now() + HOUR);
            let goal = Goal { effects: effects.clone(), ..goal() };
            let outcome = identify(&goal, &Bounds { library: &library, cancelled: &cancelled, deadline }, &|_, _| ());
            let told = parse("told", &outcome.unwrap().model, &Catalogue::built_in()).unwrap();

            let model = with_effects(&built_in("zx30u-arm").unwrap(), &effects).unwrap();
            let method = if effects.is_empty() { Method::Best } else { Method::OutputError };
            let bag = std::path::Path::new(samples).join("arm-swing");
            let recording = Preparation::default().recording(&bag, &model).unwrap();
            let study = Study::of_fitted(model, vec![recording]);
            let found = study.identify(method, &|_| ControlFlow::Continue(())).unwrap().result;
            let (found_by, found) = (found.method, found.model);
            let numbers = |model: &Model| -> Vec<_> {
                model.parameters().map(|(_, one)| (one.value, one.standard_error, one.margin_95)).collect()
            };
            assert_eq!(numbers(&told), numbers(&found), "{effects:?}");
            let done: Vec<&str> = told.history.iter().map(|entry| entry.what.as_str()).collect();
            let identified = format!("parameters identified ({found_by})");
            assert_eq!(done.last(), Some(&identified.as_str()));
            assert_eq!(done.len(), 1 + effects.len(), "{done:?}");
        }
    }

    #[test]
    fn cancelled_work_ends_within_the_stage() {
        // The second round is in the regression, the sixth in the fit of the outputs.
        for (stage, rounds) in [("identifying", 2), ("identifying", 6)] {
            let cancelled = AtomicBool::new(false);
            let seen = Cell::new(0);
            let tell = |name: &str, _: f64| {
                assert!(!cancelled.load(Ordering::Relaxed), "{name} goes on after {stage} was cancelled");
                seen.set(seen.get() + usize::from(name == stage));
                cancelled.store(seen.get() == rounds, Ordering::Relaxed);
            };
            let ended = work(HOUR, &cancelled, &tell);
            assert!(matches!(ended, Err(Ended::Cancelled)), "{stage}: {ended:?}");
            assert_eq!(seen.get(), rounds);
        }
    }

    #[test]
    fn work_ends_at_its_time_limit() {
        let ended = work(Duration::from_millis(20), &AtomicBool::new(false), &|_, _| {});
        assert!(matches!(ended, Err(Ended::TimedOut)), "{ended:?}");
    }
}
