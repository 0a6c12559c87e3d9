//! A page with what a model is missing.

use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::{Candidate, Diagnosis, Part};
use excavator_identification::energy::MissingPower;
use excavator_identification::validation::Comparison;
use excavator_model::Model;
use excavator_model::recording::Recording;
use maud::{Markup, html};

use super::comparison_page::{measures, over_time};
use super::effect_cards::effect_card;
use super::error_plots::{Errors, error_plots};
use super::evidence_tables::{evidence, regimes};
use super::page::{Section, page};
use super::plot_line::MODEL;
use super::unexplained_plot::unexplained_plot;
use super::verdict_text::verdict_sentence;
use super::{energy_tables, parameter_table};

/// A page with a diagnosis: the verdict, the evidence, and where the model fails. `comparisons_before` are the model
/// without additions on the validation recordings; `missing` is the missing power in the energy ledger of the refitted
/// model for each of them.
///
/// ```no_run
/// use excavator_identification::diagnosis::Diagnosis;
/// use excavator_identification::energy::ledgers;
/// use excavator_identification::validation::compare;
/// use excavator_model::Model;
/// use excavator_model::recording::Recording;
/// use excavator_report::diagnosis_page;
///
/// fn write(model: &Model, found: &Diagnosis, judging: &Recording) -> Result<(), Box<dyn std::error::Error>> {
///     let refitted = &found.given().fit.model;
///     let page = diagnosis_page(model, found, &[compare(refitted, judging)?], &ledgers(refitted, &[judging]));
///     Ok(std::fs::write("diagnosis.html", page)?)
/// }
/// ```
pub fn diagnosis_page(
    model: &Model,
    diagnosis: &Diagnosis,
    comparisons_before: &[Comparison],
    missing: &[(String, Vec<MissingPower>)],
) -> String {
    let lead = html! {
        p.about { (model.machine.description) }
        (verdict(model, diagnosis))
    };
    let mut sections = diagnosis_sections(diagnosis, comparisons_before);
    if !missing.is_empty() {
        sections.push(Section { anchor: "energy", title: "Missing power".into(), body: missing_power(missing) });
    }
    sections.push(Section {
        anchor: "measures",
        title: "Errors of the model".into(),
        body: measures(comparisons_before),
    });
    sections.push(Section { anchor: "time", title: "Over time".into(), body: over_time(comparisons_before, &[]) });
    sections.push(Section {
        anchor: "errors",
        title: "What the error depends on".into(),
        body: error_plots(model, &[Errors { line: MODEL, comparisons: comparisons_before }]),
    });
    sections.push(Section {
        anchor: "parameters",
        title: "Parameters of the refitted model".into(),
        body: parameter_table::of_model(model, &diagnosis.given().fit.model, &[]),
    });
    page("Diagnosis", &model.machine.name, &lead, &sections)
}

/// Results of the energy ledger, recording by recording.
fn missing_power(missing: &[(String, Vec<MissingPower>)]) -> Markup {
    html! {
        @for (source, found) in missing {
            @if missing.len() > 1 { h3 { (source) } }
            (energy_tables::evidence(found))
        }
        p.note {
            "The energy ledger of the refitted model compares the measured change of stored energy in each equation with the modelled power inflow. "
            code { "excavator energy" } " has the figures."
        }
    }
}

/// The verdict in its box.
pub(super) fn verdict(model: &Model, diagnosis: &Diagnosis) -> Markup {
    html! { p class={ "verdict " (diagnosis.verdict.kind.name()) } { (verdict_sentence(model, diagnosis)) } }
}

/// Named effects, what is left, evidence, and where the model fails.
pub(super) fn diagnosis_sections(diagnosis: &Diagnosis, comparisons: &[Comparison]) -> Vec<Section> {
    let mut sections = Vec::new();
    let named = named(diagnosis);
    if !named.is_empty() {
        let title = if named.len() == 1 { "The effect" } else { "The effects" };
        let recordings: Vec<&Recording> = comparisons.iter().map(|comparison| &comparison.measured).collect();
        let body = html! { @for candidate in &named { (effect_card(diagnosis, candidate, &recordings)) } };
        sections.push(Section { anchor: "effects", title: title.into(), body });
    }
    if let Some(left) = &diagnosis.unexplained {
        sections.push(Section {
            anchor: "unexplained",
            title: "Unexplained residual".into(),
            body: unexplained_plot(&diagnosis.given().fit.model.machine, left),
        });
    }
    sections.push(Section { anchor: "evidence", title: "Evidence".into(), body: evidence(diagnosis) });
    let adequate = diagnosis.verdict.kind == Kind::Adequate;
    let title = if adequate { "Where residuals are largest" } else { "Where the model fails" };
    sections.push(Section { anchor: "where", title: title.into(), body: regimes(&diagnosis.map) });
    sections
}

/// Effects that the verdict names: the first with its ties, then those added after it.
fn named(diagnosis: &Diagnosis) -> Vec<Candidate<'_>> {
    if diagnosis.verdict.kind == Kind::Adequate {
        return Vec::new();
    }
    let named = diagnosis.candidates().into_iter();
    named.filter(|candidate| matches!(candidate.part, Part::Selected | Part::Tied)).collect()
}
