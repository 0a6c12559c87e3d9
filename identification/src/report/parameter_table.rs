//! Parameters with units and standard errors.

use std::collections::BTreeMap;

use excavator_model::effects::{Site, Start};
use excavator_model::{Model, ModelEffect, Parameter, addition_name, site_name};
use maud::{Markup, html};

use super::numbers::{NOTHING, percent, with_error};
use super::{units, words};
use crate::fit::nuisances_shown;
use crate::value_marks::{self, ValueMark};

/// Standard error over value from which on a number is called poorly known.
const POORLY_KNOWN: f64 = 0.5;

/// All parameters of a model, effect by effect. Marked are effects in `added` (`effect@place`), and nuisance effects that show
/// since the model `given`.
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

/// With a column of effects where `marks` are given: words for some of them, by `effect@place`. The last that fits is taken.
fn table(model: &Model, effects: &[&ModelEffect], marks: Option<BTreeMap<String, &'static str>>) -> Markup {
    let (in_model, marks) = (marks.is_some(), marks.unwrap_or_default());
    let poor = effects
        .iter()
        .flat_map(|effect| &effect.parameters)
        .any(|p| relative_error(p).is_some_and(|r| r > POORLY_KNOWN));
    html! {
        @if effects.is_empty() { p.empty { "No parameters." } } @else {
            div.wide { table.data {
                thead { tr {
                    @if in_model { th { "Effect" } }
                    th { "Parameter" } th { "Symbol" } th.n { "Value ± standard error" } th { "Unit" } th.n { "Relative" }
                    th { "Meaning" } th { "From" }
                } }
                tbody { @for effect in effects {
                    @let place = site_name(&model.machine, effect.site);
                    @let mark = marks.get(&addition_name(effect.name(), place));
                    @for (number, parameter) in effect.parameters.iter().enumerate() {
                        @let relative = relative_error(parameter);
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
                p.note { "Grey: the standard error is more than half the value; these recordings hardly show this parameter." }
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
    // A window of time is read along the recording, a time constant is short.
    let is_a_time = parameter.card.start.is_a_time();
    let unit = if is_a_time { units::SECOND } else { units::of_parameter(&parameter.card.unit) };
    let error = parameter.standard_error.filter(|_| !parameter.known).unwrap_or(f64::NAN);
    let value = if is_a_time && effect.physics.value_where_left_out(&parameter.card.name) == Some(parameter.value) {
        let is_begin = parameter.card.start == Start::WorstStretchBegin;
        if is_begin { "from the beginning" } else { "to the end" }.to_string()
    } else {
        with_error(parameter.value * unit.factor, error * unit.factor)
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

/// Standard error over value of an identified parameter.
fn relative_error(parameter: &Parameter) -> Option<f64> {
    let error = parameter.standard_error.filter(|error| !parameter.known && error.is_finite())?;
    (parameter.value != 0.0).then(|| (error / parameter.value).abs())
}
