//! Tables of energies and of the ledger.

use excavator_identification::energy::{EnergyAnalysis, MissingPower, Regime};
use excavator_identification::results::ByOpening;
use excavator_model::Model;
use maud::{Markup, html};

use super::energy_text::{budget_label, delivered_by};
use super::numbers::{NOTHING, percent, significant};
use super::words;

/// Energies over the recording and per cycle: one sum.
pub(super) fn energies(model: &Model, analysis: &EnergyAnalysis) -> Markup {
    let budget = analysis.budget(model);
    let cycle = analysis.cycle_budget(model);
    let numbers = |energy: f64| {
        html! {
            td.n { (significant(energy, 4)) }
            td.n { (percent(budget.share_of(energy))) }
            td.n { (significant(energy / analysis.totals.duration, 3)) }
        }
    };
    html! {
        div.wide { table.data {
            thead { tr {
                th { "Energy" } th.n { "J" } th.n { "Share" } th.n { "Mean power, W" }
                @if let Some(cycle) = &analysis.cycle { th.n { "J per cycle of " (significant(cycle.period, 3)) " s" } }
            } }
            tbody {
                tr.group {
                    td { "delivered by the " (delivered_by(model)) } (numbers(budget.delivered))
                    @if let Some(cycle) = &cycle { td.n { (significant(cycle.mean.delivered, 3)) } }
                }
                @for line in &budget.lines { tr {
                    td { (budget_label(line)) } (numbers(line.energy))
                    @if let Some(cycle) = &cycle { td.n {
                        @match cycle.line(line) {
                            Some((mean, Some(deviation))) => { (significant(mean, 3)) " ± " (significant(deviation, 2)) },
                            Some((mean, None)) => { (significant(mean, 3)) },
                            None => { (NOTHING) },
                        }
                    } }
                } }
            }
        } }
        p.note {
            "The lines below the first add up to it. Share: of the delivered energy. "
            @if let Some(cycle) = &analysis.cycle { "Per cycle: mean and standard deviation over " (cycle.count) " whole cycles. " }
            "Powers are integrated over " (significant(analysis.totals.duration, 4)) " s of "
            (significant(analysis.duration, 4)) " s"
            @if analysis.gaps > 0 { "; " (analysis.gaps) " gaps are left out" } "."
        }
    }
}

/// Mean powers of each cylinder by the sign of its opening.
pub(super) fn by_opening(model: &Model, analysis: &EnergyAnalysis) -> Markup {
    html! {
        div.wide { table.data {
            thead { tr {
                th { "Opening" } th.n { "Time, s" } th.n { "Supplied, W" } th.n { "Gained by the oil, W" } th.n { "Gained by the links, W" }
                th.n { "Lost, W" }
            } }
            tbody { @for one in &analysis.by_opening {
                @let both = ByOpening::of(one);
                @for (sign, powers) in [("positive", both.positive), ("negative", both.negative)] {
                    tr {
                        td { (words::capitalised(&model.machine.cylinders[one.cylinder].name)) ", " (sign) }
                        @for value in [powers.duration, powers.supply, powers.oil, powers.links, powers.dissipation.map(|power| -power)] {
                            td.n { (value.map_or(NOTHING.to_string(), |value| significant(value, 3))) }
                        }
                    }
                }
            } }
        } }
        p.note { "Means over the time in which the opening has this sign. Supplied, negative: the cylinder gives power back through its valve." }
    }
}

/// The balance of the pump line in one row.
pub(super) fn pump_line(model: &Model, analysis: &EnergyAnalysis) -> Markup {
    let Some(line) = analysis.pump_line(model) else {
        return html! { p.empty { "The supply of this machine is not part of the model." } };
    };
    let joules = |value: f64| format!("{} J", significant(value, 4));
    html! {
        div.wide { table.data {
            thead { tr {
                th.n { "Pump" } th { "=" } th.n { "Bypass loss" }
                @for section in &line.sections { th { "+" } th.n { "Metering loss, " (section.cylinder) } th { "+" } th.n { "Into the " (section.cylinder) " cylinder" } }
                th { "+" } th.n { "Stored in the line" } th { "+" } th.n { "Gone missing" }
            } }
            tbody { tr {
                td.n { (joules(line.pump)) } td {} td.n { (joules(line.bypass_loss)) }
                @for section in &line.sections { td {} td.n { (joules(section.metering_loss)) } td {} td.n { (joules(section.into_cylinder)) } }
                td {} td.n { (joules(line.stored)) } td {} td.n { (joules(-line.residual)) }
            } }
        } }
    }
}

/// Missing power, place by place and condition by condition.
pub(super) fn ledger(model: &Model, analysis: &EnergyAnalysis) -> Markup {
    html! {
        p.note { "All powers in W." }
        div.wide { table.data {
            thead { tr {
                th { "Condition" } th { "Ledger" } th.n { "Missing, rms" } th.n { "explained" } th.n { "sensors" } th.n { "parameters, slopes" }
                th.n { "Mean" } th.n { "Peak" } th.n { "Flow" } th.n { "Windows" }
            } }
            tbody { @for place in &analysis.places {
                tr.group { td colspan="10" { (words::equation(&place.place.equation(model))) " " code.code-name { (place.place.equation(model)) } } }
                @for judged in place.regimes.iter().filter(|judged| judged.windows > 0) {
                    tr {
                        td { (Regime::words(judged.regime)) }
                        td { @if judged.is_explained() { span.chip { "closes" } } @else { span.chip.named { "does not close" } } }
                        @for power in [judged.size, judged.band, judged.noise, judged.parameters, judged.mean, judged.peak] {
                            td.n { (significant(power, 2)) }
                        }
                        td.n { (significant(judged.flow, 3)) }
                        td.n { (judged.windows) }
                    }
                }
            } }
        } }
    }
}

/// Missing power, in sentences.
pub(super) fn evidence(missing: &[MissingPower]) -> Markup {
    html! {
        @if missing.is_empty() { p { "The ledger closes at every equation: noise explains what is left." } }
        @else { ul { @for one in missing { li { (one.sentence) " " code.code-name { (one.equation) } } } } }
    }
}
