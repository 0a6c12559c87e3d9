//! Which effects were tried, what each gained, and where the model fails.

use excavator_model::recording::Recording;
use maud::{Markup, html};

use super::numbers::{percent, significant};
use super::verdict_text::NONE_TRIED;
use super::words;
use crate::diagnosis::{Candidate, Diagnosis, Share, normalised_error};
use crate::fit::Fit;
use crate::validation::Comparison;

/// Rows of the table of regimes.
const MOST_REGIMES: usize = 12;

/// Candidates with evidence, then the others, folded away.
pub(super) fn evidence(diagnosis: &Diagnosis, comparisons: &[Comparison]) -> Markup {
    let recordings: Vec<&Recording> = comparisons.iter().map(|comparison| &comparison.measured).collect();
    let before = normalised_error(&diagnosis.nominal_validation, &recordings);
    let tied = diagnosis.candidates.first().is_some_and(|first| first.tied_with_first);
    let rows: Vec<(&Candidate, &str, &str)> = diagnosis
        .candidates
        .iter()
        .enumerate()
        .map(|(index, candidate)| match (index, candidate.tied_with_first, tied) {
            (0, _, false) => (candidate, "named", "named"),
            (_, true, true) => (candidate, "tied", "tied: not told apart"),
            _ => (candidate, "also", "helps, but less"),
        })
        .collect();
    let rejected: Vec<(&Candidate, &str, &str)> =
        diagnosis.rejected.iter().map(|candidate| (candidate, "none", "no evidence")).collect();
    if diagnosis.tried() == 0 {
        return html! { p { (NONE_TRIED) } };
    }
    html! {
        @if rows.is_empty() { p { "None of the " (rejected.len() + diagnosis.unpromising.len()) " effects tried lowers the error by enough, and surely enough, to be named." } }
        @else { (table(&rows, before, &recordings)) }
        p.note {
            "Each effect of the catalogue was added to the model alone and all parameters were fitted again to the "
            "identification recordings; errors here are on the validation recordings, over stretches of a few seconds. "
            "Gain: fall of the mean logarithm of squared error (0.7 is half the squared error). Significance: the gain in "
            "its own standard errors from block to block. An effect is named only if both are large, in both recordings. "
            "First in: share of 500 recordings, put together from stretches of 2 s of these drawn at random, on which it "
            "gains most of all."
        }
        @if !rejected.is_empty() {
            details { summary { "Effects without evidence (" (rejected.len()) ")" } (table(&rejected, before, &recordings)) }
        }
        @if !diagnosis.unpromising.is_empty() {
            details {
                summary { "Effects left behind at the start (" (diagnosis.unpromising.len()) ")" }
                table.data {
                    thead { tr { th { "Effect" } th { "Where" } th.n { "Gain that its first steps brought or promised" } } }
                    tbody { @for effect in &diagnosis.unpromising { tr {
                        td { (words::spoken(effect.physics.card().name)) " " code.code-name { (effect.physics.card().name) } }
                        td { (effect.place) }
                        td.n { (gain(effect.promised_gain)) }
                    } } }
                }
            }
        }
        @if !diagnosis.failed.is_empty() {
            details {
                summary { "Effects that could not be fitted (" (diagnosis.failed.len()) ")" }
                table.data { tbody { @for (name, error) in &diagnosis.failed { tr { td { code { (name) } } td { (error) } } } } }
            }
        }
        @if diagnosis.chain.len() > 1 { (chain(diagnosis, before, &recordings)) }
    }
}

fn table(rows: &[(&Candidate, &str, &str)], before: f64, recordings: &[&Recording]) -> Markup {
    html! {
        div.wide { table.data {
            thead { tr {
                th { "Effect" } th { "Where" } th { "Result" } th.n { "NMSE before" } th.n { "NMSE after" } th.n { "Gain" } th.n { "Significance" } th.n { "Gain where fitted" } th.n { "First in" }
            } }
            tbody { @for (candidate, class, result) in rows {
                tr {
                    td { (words::spoken(candidate.name())) " " code.code-name { (candidate.name()) } }
                    td { (candidate.place) }
                    td { span class={ "chip " (class) } { (result) } }
                    (gain_cells(candidate, before, recordings))
                    td.n { (gain(candidate.identification_gain)) }
                    td.n { (percent(candidate.inclusion.is_first)) }
                }
            } }
        } }
    }
}

fn gain_cells(candidate: &Candidate, before: f64, recordings: &[&Recording]) -> Markup {
    html! {
        td.n { (significant(before, 3)) }
        td.n { (significant(normalised_error(&candidate.validation, recordings), 3)) }
        td.n { (gain(candidate.evidence.gain)) }
        td.n { (gain(candidate.evidence.significance)) " σ" }
    }
}

fn gain(value: f64) -> String {
    if value.is_finite() { format!("{value:.2}").replace('-', "−") } else { super::numbers::NOTHING.to_string() }
}

fn chain(diagnosis: &Diagnosis, before: f64, recordings: &[&Recording]) -> Markup {
    let error = |fit: &Fit| normalised_error(fit, recordings);
    let befores = std::iter::once(before).chain(diagnosis.chain.iter().map(|step| error(&step.validation)));
    html! {
        h3 { "Added one after the other" }
        div.wide { table.data {
            thead { tr { th { "Step" } th { "Effect" } th { "Where" } th.n { "NMSE before" } th.n { "NMSE after" } th.n { "Gain" } th.n { "Significance" } } }
            tbody { @for (number, (step, before)) in diagnosis.chain.iter().zip(befores).enumerate() {
                tr {
                    td { (number + 1) }
                    td { (words::spoken(step.name())) " " code.code-name { (step.name()) } }
                    td { (step.place) }
                    (gain_cells(step, before, recordings))
                }
            } }
        } }
    }
}

/// Where the residual is, as bars.
pub(super) fn regimes(map: &[Share]) -> Markup {
    let largest = map.iter().map(|share| share.share_of_residual).fold(0.0, f64::max);
    html! {
        @if map.is_empty() { p.empty { "No residual could be formed." } } @else {
            div.wide { table.data {
                thead { tr { th { "Equation" } th { "While" } th { "Share of the residual" } th.n { "Share of the time" } } }
                tbody { @for share in map.iter().take(MOST_REGIMES) {
                    tr {
                        td { (words::equation(&share.equation)) " " code.code-name { (share.equation) } }
                        td { (share.regime) }
                        td {
                            span.bar { i style=(format!("width:{:.1}%", bar_length(share.share_of_residual, largest))) {} }
                            (percent(share.share_of_residual))
                        }
                        td.n { (percent(share.share_of_time)) }
                    }
                } }
            } }
            p.note {
                "How much each equation fails to close, in units of sensor noise, squared, with the parameters of the "
                "refitted model." @if map.len() > MOST_REGIMES { " The smallest shares are left out." }
            }
        }
    }
}

fn bar_length(share: f64, largest: f64) -> f64 {
    if share.is_finite() && largest > 0.0 { 100.0 * share / largest } else { 0.0 }
}
