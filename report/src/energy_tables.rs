//! Tables of energies and of the ledger.

use excavator_identification::energy::{EnergyAnalysis, MissingPower, Regime, Totals};
use excavator_identification::results::ByOpening;
use excavator_model::Model;
use excavator_model::effects::ActsOn;
use excavator_model::machine::Supply;
use excavator_model::site_name;
use maud::{Markup, html};

use super::energy_flow::whole;
use super::numbers::{NOTHING, percent, significant};
use super::words;

/// Energies over the recording and per cycle.
pub(super) fn energies(model: &Model, analysis: &EnergyAnalysis) -> Markup {
    let whole = whole(model, &analysis.totals);
    let rows = lines(model, &analysis.totals);
    let cycle = analysis.cycle.as_ref().map(|cycle| (lines(model, &cycle.mean), lines(model, &cycle.deviation)));
    html! {
        div.wide { table.data {
            thead { tr {
                th { "Energy" } th { "Effect" } th.n { "J" } th.n { "Share" } th.n { "Mean power, W" }
                @if let Some(cycle) = &analysis.cycle { th.n { "J per cycle of " (significant(cycle.period, 3)) " s" } }
            } }
            tbody { @for (index, line) in rows.iter().enumerate() {
                tr class=[line.heading.then_some("group")] {
                    td { (line.what) } td { @if let Some(effect) = line.effect { code { (effect) } } }
                    td.n { (significant(line.energy, 4)) }
                    td.n { (percent(line.energy / whole)) }
                    td.n { (significant(line.energy / analysis.totals.duration, 3)) }
                    @if let Some((mean, deviation)) = &cycle {
                        td.n { (mean.get(index).map_or(NOTHING.to_string(), |own| significant(own.energy, 3))) " ± "
                            (deviation.get(index).filter(|own| !own.derived).map_or(NOTHING.to_string(), |own| significant(own.energy.abs(), 2))) }
                    }
                }
            } }
        } }
        p.note {
            "Share: of the energy that the pump delivered, or where the model has no pump of what the cylinders were given. "
            @if let Some(cycle) = &analysis.cycle { "Per cycle: mean and standard deviation over " (cycle.count) " whole cycles. " }
            "Powers are integrated over " (significant(analysis.totals.duration, 4)) " s of "
            (significant(analysis.duration, 4)) " s"
            @if analysis.gaps > 0 { "; " (analysis.gaps) " gaps are left out" } "."
        }
    }
}

/// Label for the unexplained gain of a ledger that does not close.
const UNEXPLAINED: &str = "gained without explanation";

struct Line<'a> {
    what: String,
    effect: Option<&'a str>,
    energy: f64,
    heading: bool,
    /// Whether it is a difference of other lines. Its deviation is not the difference of theirs.
    derived: bool,
}

fn lines<'a>(model: &Model, totals: &'a Totals) -> Vec<Line<'a>> {
    let mut lines = Vec::new();
    let mut add = |what: String, effect: Option<&'a str>, energy: f64, heading: bool| {
        let derived = what.starts_with(UNEXPLAINED);
        lines.push(Line { what, effect, energy, heading, derived });
    };
    if matches!(model.machine.supply, Supply::PumpLine(_)) {
        add("Pump".into(), None, totals.pump, true);
        for effect in totals.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve && effect.has_power) {
            if effect.into_pump_line != 0.0 {
                add("lost between pump and tank".into(), Some(&effect.effect), -effect.into_pump_line, false);
            }
        }
        for (cylinder, own) in model.machine.cylinders.iter().zip(&totals.cylinders) {
            add(format!("lost metering in the {} valve section", cylinder.name), None, own.metering_loss, false);
        }
        add("stored in the pump line".into(), None, totals.pump_line, false);
        add(format!("{UNEXPLAINED} in the pump line"), None, totals.pump_residual(), false);
    }
    for (index, (cylinder, own)) in model.machine.cylinders.iter().zip(&totals.cylinders).enumerate() {
        add(format!("Supplied to the {} cylinder", cylinder.name), None, own.supplied, true);
        for effect in totals.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve && effect.has_power) {
            if site_name(&model.machine, effect.site) == cylinder.name {
                add("dissipated".into(), Some(&effect.effect), -effect.into_cylinders, false);
            }
        }
        add("gain of kinetic energy".into(), None, own.kinetic, false);
        add("gain of potential energy".into(), None, own.potential, false);
        add("gain of compression energy, cap side".into(), None, own.cap_internal, false);
        add("gain of compression energy, rod side".into(), None, own.rod_internal, false);
        add(UNEXPLAINED.into(), None, totals.residual(index), false);
    }
    lines
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
