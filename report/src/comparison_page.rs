//! A page that compares a model with recordings.

use excavator_identification::validation::{Baselines, Comparison, mean_error_of};
use excavator_model::Model;
use maud::{Markup, html};

use super::beside::{Beside, comparison_lines};
use super::comparison_text::{comparison_sentence, others_sentence};
use super::error_plots::{Errors, error_plots};
use super::numbers::significant;
use super::page::{Section, page, tile};
use super::plot_line::MODEL;
use super::time_plots::{hint, time_plots};
use super::{parameter_table, signal_tables};

/// A page that compares `model` with recordings: measures, every signal over time, and every signal's error against
/// command, speed, pressure and position.
///
/// `baselines` are those of the comparisons, in their order; `others` belong to the first one.
pub fn comparison_page(
    model: &Model,
    comparisons: &[Comparison],
    baselines: &[Baselines],
    others: &[Beside<'_>],
) -> String {
    let mean = mean_error_of(comparisons);
    let duration: f64 = comparisons.iter().map(|comparison| comparison.measured.duration()).sum();
    let lead = html! {
        p.about { (model.machine.description) }
        @for (comparison, baselines) in comparisons.iter().zip(baselines) {
            p.verdict { (comparison_sentence(comparison, baselines)) }
        }
        @if let Some(first) = comparisons.first() { @for other in others { p { (others_sentence(first, *other)) } } }
        div.tiles {
            (tile(&significant(mean, 3), "mean NMSE"))
            @for other in others { (tile(&significant(other.comparison().mean_error(), 3), &format!("mean NMSE, {}", other.label()))) }
            (tile(&comparisons.len().to_string(), if comparisons.len() == 1 { "recording" } else { "recordings" }))
            (tile(&format!("{duration:.1} s"), "duration"))
            (tile(&model.effects.len().to_string(), "effects in the model"))
        }
    };
    let mut sections = vec![
        Section { anchor: "measures", title: "Errors".into(), body: measures(comparisons) },
        Section { anchor: "time", title: "Over time".into(), body: over_time(comparisons, others) },
        Section {
            anchor: "errors",
            title: "What the error depends on".into(),
            body: error_plots(model, &[Errors { line: MODEL, comparisons }]),
        },
    ];
    sections.push(Section {
        anchor: "parameters",
        title: "Parameters".into(),
        body: parameter_table::of_model(model, model, &[]),
    });
    page("Comparison", &model.machine.name, &lead, &sections)
}

/// Recordings and measures.
pub(super) fn measures(comparisons: &[Comparison]) -> Markup {
    html! { (signal_tables::recordings(comparisons)) (signal_tables::measures(comparisons)) }
}

/// All recordings over time.
pub(super) fn over_time(comparisons: &[Comparison], others: &[Beside<'_>]) -> Markup {
    html! {
        @if comparisons.is_empty() { p.empty { "No recording." } } @else { (hint()) }
        @for (number, comparison) in comparisons.iter().enumerate() {
            @if comparisons.len() > 1 { h3 { "Recording " (number + 1) ": " (comparison.measured.source) } }
            (time_plots(&comparison_lines(comparison, if number == 0 { others } else { &[] }), number, comparisons.len()))
        }
    }
}
