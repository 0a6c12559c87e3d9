//! Proposed laws: one page to show to a colleague.

use excavator_identification::diagnosis::contribution;
use excavator_identification::proposal::{Finding, Proposal, ProposalVerdict, Proposals, Survey};
use excavator_identification::validation::{Comparison, compare};
use excavator_model::Model;
use excavator_model::machine::Machine;
use excavator_model::recording::Recording;
use maud::{Markup, html};

use super::diagnosis_page::diagnosis_sections;
use super::effect_plot::effect_plot;
use super::frontier_plot::frontier_plot;
use super::numbers::{percent, ratio, significant};
use super::page::{Section, page, tile};
use super::parameter_table;
use super::plot_line::{AFTER, BEFORE, Line};
use super::proposal_text::{numbers, proposal_sentence};
use super::time_plots::{hint, time_plots};
use super::unexplained_plot::unexplained_plot;

/// A page with proposed laws: the missing physics as a curve with the laws on it, error against complexity, and the
/// comparison with the measurement before and after.
pub fn proposal_page(model: &Model, found: &Proposals) -> String {
    let class = if found.kind == ProposalVerdict::Law { "missing_effect" } else { "unexplained" };
    let lead = html! {
        p.about { (model.machine.description) }
        p class={ "verdict " (class) } { (proposal_sentence(model, found)) }
        @if let Some(first) = found.proposals.first() {
            div.tiles {
                (tile(&significant(found.error_before, 3), "NMSE of the refitted model"))
                (tile(&significant(first.validation_error, 3), "NMSE with the first proposal"))
                (tile(&format!("{} ×", ratio(found.error_before / first.validation_error)), "less squared error"))
            }
        }
    };
    let machine = &found.diagnosis.given().fit.model.machine;
    let recordings: Vec<&Recording> = found.before.iter().map(|comparison| &comparison.measured).collect();
    let mut sections = Vec::new();
    if let Some(left) = &found.lacking {
        sections.push(Section {
            anchor: "lacking",
            title: "What the equations lack".into(),
            body: unexplained_plot(machine, left),
        });
    }
    if !found.survey.rows.is_empty() {
        let body = survey(&found.survey);
        sections.push(Section { anchor: "needs", title: "Where, and of what".into(), body });
    }
    if !found.proposals.is_empty() {
        let body = html! {
            (table(found))
            @for proposal in found.proposals.iter().filter(|proposal| is_favoured(found, proposal)).take(MOST_SHOWN) {
                (shown(found, proposal, machine, &recordings))
            }
        };
        sections.push(Section { anchor: "laws", title: "Proposed laws".into(), body });
        let frontier = html! {
            (frontier_plot(found))
            p.note {
                "Each dot is a law that was fitted. The line joins the best law for each number of parameters. More parameters pay off "
                "only where the line falls."
            }
        };
        sections.push(Section { anchor: "frontier", title: "Error against complexity".into(), body: frontier });
        sections.push(Section { anchor: "time", title: "Before and after, over time".into(), body: over_time(found) });
    }
    sections
        .extend(diagnosis_sections(&found.diagnosis, &found.before).into_iter().filter(|one| one.anchor != "effects"));
    page("Proposed laws", &model.machine.name, &lead, &sections)
}

/// Largest number of laws with a picture of their own.
const MOST_SHOWN: usize = 3;

/// Rows and variables that the predictions for single terms support.
fn survey(survey: &Survey) -> Markup {
    let table = |head: &str, last: &str, findings: &[Finding]| {
        html! {
            table.data {
                thead { tr { th { (head) } th.n { (last) } } }
                tbody { @for one in findings.iter().take(MOST_FINDINGS) { tr { td { code { (one.name) } } td.n { (percent(one.share)) } } } }
            }
        }
    };
    html! {
        (table("Equation", "share of the best", &survey.rows))
        (table("Variable", "share lost without it", &survey.variables))
        p.note {
            "Predicted improvement of terms with one product, before any is fitted. First table: the best term in each equation, relative to "
            "the best of all. Second table: the share that is lost when no term may use the variable; " code { "z" } " is a state with "
            "memory. These recordings do not separate equations or variables with similar shares."
        }
    }
}

/// Largest number of rows and variables in the survey.
const MOST_FINDINGS: usize = 8;

fn table(found: &Proposals) -> Markup {
    html! {
        div.wide { table.data {
            thead { tr { th { "Law" } th { "Acts on" } th { "Where" } th { "Fitted numbers (± 95 %)" } th.n { "NMSE after" } th { "Result" } th { "Remarks" } } }
            tbody { @for proposal in &found.proposals { tr {
                td { code { (proposal.text.formula) } }
                td { (proposal.text.acts_on.replace('_', " ")) }
                td { (proposal.place) @if !proposal.beside.is_empty() { " beside " code { (proposal.beside.join(", ")) } } }
                td { (numbers(proposal).join(", ")) }
                td.n { (significant(proposal.validation_error, 3)) }
                td { (result(found, proposal)) }
                td { (proposal.remarks().join("; ")) }
            } } }
        } }
        p.note {
            "NMSE: mean squared error over the variance of each signal, on the validation recordings, to which nothing was fitted; before: "
            (significant(found.error_before, 3)) ". Every law is a formula effect: write it with " code { "-o laws.toml" }
            ", edit it, add it with " code { "excavator refine --catalogue laws.toml --add NAME" } "."
        }
    }
}

/// What a proposal is, in a word or two.
pub fn result(found: &Proposals, proposal: &Proposal) -> &'static str {
    let is_alone = found.diagnosis.verdict.set.len() < 2;
    match (found.kind, is_favoured(found, proposal)) {
        _ if proposal.is_a_curve => "curve",
        _ if proposal.validation_error >= found.error_before => "no better",
        (ProposalVerdict::Law, true) if is_alone => "explains it",
        (ProposalVerdict::Law, true) => "tied",
        (_, true) => "nearest",
        (_, false) => "helps less",
    }
}

/// Whether it explains the recordings or, if no law does, belongs to the hypothesis that comes nearest.
fn is_favoured(found: &Proposals, proposal: &Proposal) -> bool {
    let is_nearest = found.proposals.first().is_some_and(|first| first.trial == proposal.trial);
    proposal.is_in_set || found.kind == ProposalVerdict::NoLaw && is_nearest
}

/// The law, drawn on the residual of the equation, and its numbers.
fn shown(found: &Proposals, proposal: &Proposal, machine: &Machine, recordings: &[&Recording]) -> Markup {
    let trial = &found.diagnosis.trials[proposal.trial];
    let addition = trial.additions.iter().find(|addition| addition.physics.card().name == proposal.text.name);
    // If the picture cannot be made, its place stays empty.
    let contribution = addition.and_then(|addition| contribution(trial, addition, recordings).ok().flatten());
    html! {
        div.card {
            h3 { code { (proposal.text.formula) } " " code.code-name { (proposal.text.name) "@" (proposal.place) } }
            @if let Some(contribution) = &contribution { (effect_plot(machine, contribution)) }
            (parameter_table::of_effect(&trial.fit.model, &proposal.text.name, proposal.effect.site))
        }
    }
}

/// The recording with the largest error of the model, before and with the first proposal.
fn over_time(found: &Proposals) -> Markup {
    let worst =
        (0..found.before.len()).max_by(|&a, &b| found.before[a].mean_error().total_cmp(&found.before[b].mean_error()));
    let pair = worst.zip(found.proposals.first()).and_then(|(worst, first)| {
        let before = &found.before[worst];
        let after = compare(&found.diagnosis.trials[first.trial].model_on_validation(), &before.measured).ok()?;
        Some((before, after))
    });
    let Some((before, after)) = pair else {
        return html! { p.empty { "The laws cannot be simulated on the whole recording." } };
    };
    let lines: Vec<(Line, &Comparison)> = vec![(BEFORE, before), (AFTER, &after)];
    html! {
        p { "Recording " code { (before.measured.source) } "." (hint()) }
        (time_plots(&lines, 0, 1))
    }
}
