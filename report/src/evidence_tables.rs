//! Tables of the tried effects, their gains, and where the model fails.

use excavator_identification::diagnosis::{Candidate, Diagnosis, Part, Share};
use maud::{Markup, html};

use super::numbers::{percent, significant};
use super::verdict_text::NONE_TRIED;
use super::words;

/// Largest number of rows in the table of regimes.
const MOST_REGIMES: usize = 12;

/// Candidates with evidence, then the others, collapsed.
pub(super) fn evidence(diagnosis: &Diagnosis) -> Markup {
    let (rows, rejected) = (diagnosis.candidates(), diagnosis.rejected());
    if diagnosis.tried() == 0 {
        return html! { p { (NONE_TRIED) } };
    }
    html! {
        @if rows.is_empty() {
            p { "None of the " (rejected.len() + diagnosis.unpromising.len()) " effects that were tried lowers the error by enough to be attributed." }
        } @else { (table(&rows)) }
        p.note {
            "Each effect of the catalogue was added to the model, and all parameters were fitted again to the identification recordings. "
            "The mean NMSE is that of the whole validation recordings, simulated from their first states, as in every comparison. The log error "
            "ratio compares the squared error with the noise variance in blocks of 0.5 s: 0 is noise alone, 0.7 is twice its variance. Improvement: the fall of this "
            "ratio when the effect is added. Significance: the improvement on all recordings, in standard errors from stretch to stretch. First in: share of 500 "
            "resampled recordings in which the hypothesis is the best of all."
        }
        @if !rejected.is_empty() {
            details { summary { "Effects without evidence (" (rejected.len()) ")" } (table(&rejected)) }
        }
        @if !diagnosis.unpromising.is_empty() {
            details {
                summary { "Effects dropped in the screening (" (diagnosis.unpromising.len()) ")" }
                div.wide { table.data {
                    thead { tr { th { "Effect" } th { "Where" } th.n { "Improvement that its first steps brought or promised" } } }
                    tbody { @for effect in &diagnosis.unpromising { tr {
                        td { (words::spoken(&effect.effect)) " " code.code-name { (effect.effect) } }
                        td { (effect.place) }
                        td.n { (two_digits(effect.promised_improvement)) }
                    } } }
                } }
            }
        }
        @if !diagnosis.failed.is_empty() {
            details {
                summary { "Effects that could not be fitted (" (diagnosis.failed.len()) ")" }
                div.wide { table.data { tbody { @for (name, error) in &diagnosis.failed { tr { td { code { (name) } } td { (error) } } } } } }
            }
        }
    }
}

fn table(rows: &[Candidate<'_>]) -> Markup {
    html! {
        div.wide { table.data {
            thead { tr {
                th { "Effect" } th { "Where" } th { "Result" } th.n { "Mean NMSE before" } th.n { "Mean NMSE after" } th.n { "Improvement" }
                th.n { "Significance" } th.n { "Improvement where fitted" } th.n { "First in" }
            } }
            tbody { @for candidate in rows {
                @let class = class_of(candidate);
                tr {
                    td { (words::spoken(candidate.name())) " " code.code-name { (candidate.name()) } }
                    td { (candidate.place()) }
                    td { span class={ "chip " (class) } { (candidate.result()) } }
                    @for error in candidate.errors { td.n { (significant(error.unwrap_or(f64::NAN), 3)) } }
                    td.n { (two_digits(candidate.improvement)) }
                    td.n { (two_digits(candidate.standing.significance)) " σ" }
                    td.n { (two_digits(candidate.standing.identification_improvement)) }
                    td.n { (percent(candidate.standing.is_first)) }
                }
            } }
        } }
    }
}

/// CSS class for the role of an effect in the verdict.
fn class_of(candidate: &Candidate<'_>) -> &'static str {
    match candidate.part {
        _ if candidate.is_tied_with_first => "tied",
        Part::Tied => "tied",
        Part::Selected => "named",
        Part::Improves => "also",
        Part::NoEvidence => "none",
    }
}

fn two_digits(value: f64) -> String {
    match format!("{value:.2}").as_str() {
        _ if !value.is_finite() => super::numbers::NOTHING.to_string(),
        "-0.00" => "0.00".to_string(),
        text => text.replace('-', "−"),
    }
}

/// Distribution of the residual, as bars.
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
                "Squared residual of each equation in units of sensor noise, for the refitted model." @if map.len() > MOST_REGIMES { " The smallest shares are left out." }
            }
        }
    }
}

fn bar_length(share: f64, largest: f64) -> f64 {
    if share.is_finite() && largest > 0.0 { 100.0 * share / largest } else { 0.0 }
}
