//! Plots an effect as shown by the data.

use excavator_identification::diagnosis::{Contribution, ContributionBin, Drawn};
use excavator_model::machine::Machine;
use maud::{Markup, html};

use super::numbers::SIDES_95;
use super::residual_units::{unit_of_residual, unit_of_variable};
use super::svg::{Frame, picture, range_of};
use super::words;

const DATA: &str = "var(--purple)";
const EFFECT: &str = "var(--brown)";
const NOMINAL: &str = "var(--grey)";

/// Data, the fitted law and the model without the effect, in the axes of a textbook.
pub(super) fn effect_plot(machine: &Machine, shown: &Contribution) -> Markup {
    let x_unit = unit_of_variable(machine, &shown.equation, shown.variable);
    let y_unit = if shown.drawn == Drawn::Opening { x_unit } else { unit_of_residual(shown.unit) };
    let (x, y) = (x_unit.factor, y_unit.factor);
    let line = |height: fn(&ContributionBin) -> f64| -> Vec<(f64, f64)> {
        shown.bins.iter().map(|bin| (bin.at * x, height(bin) * y)).collect()
    };
    let data = line(|bin| bin.nominal + bin.lacking);
    let law = line(|bin| bin.nominal + bin.effect);
    let nominal = line(|bin| bin.nominal);
    let margin = |bin: &ContributionBin| SIDES_95 * bin.standard_error * y;
    let whiskers: Vec<(f64, f64, f64)> =
        shown.bins.iter().zip(&data).map(|(bin, &(at, mean))| (at, mean - margin(bin), mean + margin(bin))).collect();
    let size = (760.0, 320.0);
    let heights = whiskers.iter().flat_map(|&(_, low, high)| [low, high, 0.0]);
    let frame = Frame {
        size,
        margins: (64.0, 12.0, 24.0, 40.0),
        x: range_of(data.iter().map(|point| point.0)),
        y: range_of(heights.chain(law.iter().chain(&nominal).map(|point| point.1))),
    };
    let x_label = format!("{} ({})", abscissa(shown), x_unit.symbol);
    let y_label = format!("{} ({})", ordinate(shown.drawn), y_unit.symbol);
    let content = html! {
        (frame.axes(&x_label, &y_label))
        (frame.band(&whiskers, DATA))
        (frame.line(&nominal, NOMINAL, true))
        (frame.line(&law, EFFECT, false))
        @for (x, y) in &data { circle cx=(frame.at_x(*x)) cy=(frame.at_y(*y)) r="2.6" style={ "fill:" (DATA) } {} }
    };
    html! {
        div.key {
            span style={ "--swatch:" (DATA) } { "recordings, with a 95 % band" }
            span style={ "--swatch:" (EFFECT) } { "model with the effect" }
            span style={ "--swatch:" (NOMINAL) } { "model without it" }
        }
        (picture(size, &format!("{y_label} against {x_label}"), &content))
        p.note { (explanation(shown)) }
    }
}

fn abscissa(shown: &Contribution) -> String {
    if shown.drawn == Drawn::Opening { "commanded opening".to_string() } else { words::variable(shown.variable) }
}

fn ordinate(drawn: Drawn) -> &'static str {
    match drawn {
        Drawn::Residual => "missing without it",
        Drawn::Friction => "friction",
        Drawn::Opening => "effective opening",
    }
}

/// How the picture was made.
fn explanation(shown: &Contribution) -> Markup {
    let equation = words::equation(&shown.equation);
    let what = match shown.drawn {
        Drawn::Residual => "what the equation lacks when the effect is taken out of the fitted model",
        Drawn::Friction => {
            "nominal friction, plus what the equation lacks when the effect is taken out of the fitted model"
        }
        Drawn::Opening => {
            "the opening that the flow implies: the commanded opening plus the residual of the equation without the effect, \
             divided by the flow per opening"
        }
    };
    html! {
        "From the " (equation) " (" code { (shown.equation) } ") on the validation recordings. Dots: " (what) ". Where the dots "
        "leave the line of the model with the effect, more physics is missing."
    }
}
