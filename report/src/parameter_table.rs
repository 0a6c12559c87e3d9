//! Parameters with units and 95 % intervals.

use std::collections::BTreeMap;

use excavator_identification::fit::nuisances_shown;
use excavator_identification::value_marks::{self, ValueMark};
use excavator_model::effects::{Site, Start};
use excavator_model::{Model, ModelEffect, Parameter, addition_name, site_name};
use maud::{Markup, html};

use super::numbers::{NOTHING, SIDES_95, percent, with_margin};
use super::{units, words};

/// Ratio of the half width of the 95 % interval to the value above which a number counts as poorly known.
const POORLY_KNOWN: f64 = 1.0;

/// All parameters of a model, effect by effect. Effects in `added` (`effect@place`) are marked, and nuisance effects
/// that show and that the model `given` lacks.
pub(super) fn of_model(given: &Model, model: &Model, added: &[String]) -> Markup {
    let effects: Vec<&ModelEffect> = model.effects.iter().filter(|effect| !effect.parameters.is_empty()).collect();
    let marks = nuisances_shown(given, model)
        .map(|effect| addition_name(effect.name(), site_name(&model.machine, effect.site)))
        .map(|name| (name, "nuisance"))
        .chain(added.iter().map(|name| (name.clone(), "added")))
        .collect();
    table(model, &effects, Some(marks))
}

/// Parameters of one effect of a model.
pub(super) fn of_effect(model: &Model, name: &str, site: Site) -> Markup {
    let effects: Vec<&ModelEffect> =
        model.effects.iter().filter(|effect| effect.name() == name && effect.site == site).collect();
    table(model, &effects, None)
}

/// The table has a column of effects if `marks` are given: labels for some of them, by `effect@place`. The last label
/// of an effect applies.
fn table(model: &Model, effects: &[&ModelEffect], marks: Option<BTreeMap<String, &'static str>>) -> Markup {
    let (in_model, marks) = (marks.is_some(), marks.unwrap_or_default());
    let poor = effects
        .iter()
        .flat_map(|effect| &effect.parameters)
        .any(|p| relative_margin(p).is_some_and(|r| r > POORLY_KNOWN));
    html! {
        @if effects.is_empty() { p.empty { "No parameters." } } @else {
            div.wide { table.data {
                thead { tr {
                    @if in_model { th { "Effect" } }
                    th { "Parameter" } th { "Symbol" } th.n { "Value ± 95 %" } th { "Unit" } th.n { "Relative" }
                    th { "Meaning" } th { "From" }
                } }
                tbody { @for effect in effects {
                    @let place = site_name(&model.machine, effect.site);
                    @let mark = marks.get(&addition_name(effect.name(), place));
                    @for (number, parameter) in effect.parameters.iter().enumerate() {
                        @let relative = relative_margin(parameter);
                        tr.weak[relative.is_some_and(|relative| relative > POORLY_KNOWN)].first[in_model && number == 0] {
                            @if in_model {
                                td { @if number == 0 {
                                    (words::spoken(effect.name()))
                                    @if let Some(mark) = mark { " " span.chip.also { (mark) } }
                                } }
                            }
                            @let doubt = value_marks::mark(model, effect, parameter).filter(|_| parameter.source == "identified" || parameter.standard_error.is_some());
                            (cells(effect, place, parameter, relative, doubt.as_ref()))
                        }
                    }
                } }
            } }
            @if poor {
                p.note { "Grey: the 95 % interval is as wide as the value itself; these recordings hardly determine this parameter." }
            }
        }
    }
}

fn cells(
    effect: &ModelEffect,
    place: &str,
    parameter: &Parameter,
    relative: Option<f64>,
    mark: Option<&ValueMark>,
) -> Markup {
    // A window of time is read on the time axis of the recording; a time constant is short.
    let is_a_time = parameter.card.start.is_a_time();
    let unit = if is_a_time { units::SECOND } else { units::of_parameter(&parameter.card.unit) };
    let margin = margin(parameter).unwrap_or(f64::NAN);
    let value = if is_a_time && effect.physics.value_where_left_out(&parameter.card.name) == Some(parameter.value) {
        let is_begin = parameter.card.start == Start::WorstStretchBegin;
        if is_begin { "from the beginning" } else { "to the end" }.to_string()
    } else {
        with_margin(parameter.value * unit.factor, margin * unit.factor)
    };
    let relative = match relative {
        Some(relative) if relative < 10.0 => percent(relative),
        Some(_) => "> 1000 %".to_string(),
        None => NOTHING.to_string(),
    };
    html! {
        td { code { (place) "." (parameter.card.name) } }
        td { (parameter.card.symbol) }
        td.n { (value) }
        td.unit { (unit.symbol) }
        td.n { (relative) }
        td.meaning { (parameter.card.meaning) }
        td { (origin(parameter)) @if let Some(mark) = mark { "; " strong { (mark) } } }
    }
}

fn origin(parameter: &Parameter) -> String {
    match (parameter.known, parameter.source.as_str()) {
        (true, "") => "known".to_string(),
        (true, source) => format!("known; {source}"),
        (false, _) if parameter.standard_error.is_some() => "identified".to_string(),
        (false, source) => source.to_string(),
    }
}

/// Half width of the 95 % interval of an identified parameter, in the parameter's unit.
fn margin(parameter: &Parameter) -> Option<f64> {
    let from_error = parameter.standard_error.map(|error| SIDES_95 * error);
    parameter.margin_95.or(from_error).filter(|margin| !parameter.known && margin.is_finite())
}

/// Ratio of that half width to the value.
fn relative_margin(parameter: &Parameter) -> Option<f64> {
    margin(parameter).filter(|_| parameter.value != 0.0).map(|margin| (margin / parameter.value).abs())
}
