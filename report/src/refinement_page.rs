//! A page on the way from the given model to a better one.

use excavator_identification::diagnosis::Diagnosis;
use excavator_identification::refinement::Refinement;
use excavator_identification::validation::Comparison;
use excavator_model::{HistoryEntry, Model};
use maud::{Markup, html};

use super::diagnosis_page::{diagnosis_sections, verdict};
use super::error_plots::{Errors, error_plots};
use super::named_text::refinement_sentence;
use super::numbers::significant;
use super::page::{Section, page, tile};
use super::parameter_table;
use super::plot_line::{AFTER, BEFORE, Line, MODEL};
use super::signal_tables::{Stages, recordings};
use super::step_plot::step_plot;
use super::time_plots::{hint, time_plots};

/// A page with the steps of a refinement: errors step by step, signals before and after, the final model, and its
/// diagnosis.
///
/// ```no_run
/// use excavator_identification::diagnosis::DiagnosisSettings;
/// use excavator_identification::refinement::{Additions, refine};
/// use excavator_model::Model;
/// use excavator_model::recording::Recording;
/// use excavator_report::refinement_page;
///
/// fn write(model: &Model, fitted: &Recording, judging: &Recording) -> Result<(), Box<dyn std::error::Error>> {
///     let (settings, when) = (DiagnosisSettings::default(), "2026-05-01T12:00:00Z");
///     let progress = |_: &str, _: f64| ();
///     let refinement = refine(model, &[fitted], &[judging], &Additions::Auto, &settings, when, &progress)?;
///     Ok(std::fs::write("refinement.html", refinement_page(&refinement))?)
/// }
/// ```
pub fn refinement_page(refinement: &Refinement) -> String {
    let model = &refinement.model;
    let stages = Stages::of(refinement);
    let (before, after) = before_and_after(refinement);
    let added: Vec<String> = refinement.steps.iter().filter_map(|step| step.added.clone()).collect();
    let lead = html! {
        p.about { (model.machine.description) }
        @match refinement.diagnosis() {
            Some(diagnosis) => (verdict(&refinement.given_model, diagnosis)),
            None => p.verdict { (refinement_sentence(refinement)) },
        }
        (tiles(&stages))
    };
    let models: Vec<(Line, &[Comparison])> = match before {
        Some(before) => vec![(BEFORE, before), (AFTER, after)],
        None => vec![(MODEL, after)],
    };
    let steps = html! { (stages.table()) (step_plot(&stages)) (about_steps(refinement)) };
    let mut sections = vec![
        Section { anchor: "steps", title: "Step by step".into(), body: steps },
        Section { anchor: "time", title: "Before and after, over time".into(), body: overlay(&models) },
        Section { anchor: "errors", title: "What the error depends on".into(), body: errors(model, &models) },
        Section {
            anchor: "parameters",
            title: "Parameters of the final model".into(),
            body: parameter_table::of_model(&refinement.given_model, model, &added),
        },
    ];
    if let Some(diagnosis) = refinement.diagnosis() {
        sections.extend(of_diagnosis(diagnosis, refinement));
    }
    sections.push(Section { anchor: "recordings", title: "Validation recordings".into(), body: recordings(after) });
    sections.push(Section { anchor: "history", title: "History".into(), body: history(&model.history) });
    page("Refinement", &model.machine.name, &lead, &sections)
}

fn of_diagnosis(diagnosis: &Diagnosis, refinement: &Refinement) -> Vec<Section> {
    let before = refinement.steps.first().map_or(&[][..], |step| &step.comparisons);
    diagnosis_sections(diagnosis, before)
}

/// Comparisons before anything was added (refitted; as given where nothing was added) and of the final model.
fn before_and_after(refinement: &Refinement) -> (Option<&[Comparison]>, &[Comparison]) {
    let after = refinement.steps.last().map_or(refinement.given.as_slice(), |step| &step.comparisons);
    let before = match refinement.steps.as_slice() {
        [first, _, ..] => Some(first.comparisons.as_slice()),
        [_] if !refinement.given.is_empty() => Some(refinement.given.as_slice()),
        _ => None,
    };
    (before, after)
}

fn tiles(stages: &Stages) -> Markup {
    html! {
        div.tiles {
            @for (name, mean) in stages.names.iter().zip(&stages.mean) { (tile(&significant(*mean, 3), &format!("mean NMSE, {name}"))) }
        }
    }
}

fn about_steps(refinement: &Refinement) -> Markup {
    html! {
        p.note {
            "Every error is on validation recordings, to which nothing was fitted: the whole recording simulated from its "
            "first state with its own input. "
            @if refinement.given.is_empty() { "The model as given cannot be simulated on them, so the story starts with its refit. " }
            @else { "“As given”: with the numbers of the model file. " }
            "“Refitted”: the same physics, parameters identified again. Each addition is fitted together with all other parameters."
        }
    }
}

/// The recording with the largest error of the first model.
fn overlay(models: &[(Line, &[Comparison])]) -> Markup {
    let errors = models.first().map_or(&[][..], |(_, comparisons)| comparisons);
    let worst = (0..errors.len()).max_by(|&a, &b| errors[a].mean_error().total_cmp(&errors[b].mean_error()));
    let chosen: Vec<(Line, &Comparison)> = worst
        .map(|worst| models.iter().filter_map(|(line, comparisons)| Some((*line, comparisons.get(worst)?))).collect())
        .unwrap_or_default();
    html! {
        @if let Some((_, comparison)) = chosen.first() {
            p {
                "Recording " code { (comparison.measured.source) } ", "
                (format!("{:.1} s", comparison.measured.duration()))
                @if errors.len() > 1 { ", the one of " (errors.len()) " on which the model was furthest off" } "."
            }
            (hint())
        }
        (time_plots(&chosen, 0, 1))
    }
}

fn errors(model: &Model, models: &[(Line, &[Comparison])]) -> Markup {
    let models: Vec<Errors<'_>> = models.iter().map(|&(line, comparisons)| Errors { line, comparisons }).collect();
    error_plots(model, &models)
}

fn history(entries: &[HistoryEntry]) -> Markup {
    let error = |value: Option<f64>| significant(value.unwrap_or(f64::NAN), 3);
    html! {
        @if entries.is_empty() { p.empty { "Nothing has been done to this model yet." } } @else {
            div.wide { table.data {
                thead { tr { th { "When" } th { "What" } th.n { "NMSE before" } th.n { "NMSE after" } th { "Recordings" } } }
                tbody { @for entry in entries {
                    tr {
                        td { (entry.when) } td { (entry.what) }
                        td.n { (error(entry.validation_error_before)) } td.n { (error(entry.validation_error_after)) }
                        td.source { @for recording in &entry.recordings { div { code { (recording) } } } }
                    }
                } }
            } }
        }
    }
}
