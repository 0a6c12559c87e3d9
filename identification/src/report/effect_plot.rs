//! An effect as the data show it.

use excavator_model::machine::Machine;
use maud::{Markup, html};

use super::residual_units::{unit_of_residual, unit_of_variable};
use super::svg::{Frame, picture, range_of};
use super::words;
use crate::diagnosis::Contribution;

/// Half width of a 95 % band in standard errors.
const BAND: f64 = 1.96;
const DATA: &str = "#7b4a9a";
const EFFECT: &str = "#c2571a";

/// What the equation lacks without the effect, and what the fitted effect gives.
pub(super) fn effect_plot(machine: &Machine, shown: &Contribution) -> Markup {
    let (x_unit, y_unit) = (unit_of_variable(machine, &shown.equation, shown.variable), unit_of_residual(shown.unit));
    let (x, y) = (x_unit.factor, y_unit.factor);
    let data: Vec<(f64, f64)> = shown.bins.iter().map(|bin| (bin.at * x, bin.lacking * y)).collect();
    let effect: Vec<(f64, f64)> = shown.bins.iter().map(|bin| (bin.at * x, bin.effect * y)).collect();
    let margin = |error: f64| BAND * error * y;
    let whiskers: Vec<(f64, f64, f64)> = shown
        .bins
        .iter()
        .map(|bin| {
            (bin.at * x, bin.lacking * y - margin(bin.standard_error), bin.lacking * y + margin(bin.standard_error))
        })
        .collect();
    let size = (760.0, 320.0);
    let frame = Frame {
        size,
        margins: (64.0, 12.0, 24.0, 40.0),
        x: range_of(data.iter().map(|point| point.0)),
        y: range_of(whiskers.iter().flat_map(|&(_, low, high)| [low, high, 0.0]).chain(effect.iter().map(|e| e.1))),
    };
    let x_label = format!("{} ({})", words::variable(shown.variable), x_unit.symbol);
    let y_label = format!("lacking without it ({})", y_unit.symbol);
    let content = html! {
        (frame.axes(&x_label, &y_label))
        (frame.band(&whiskers, DATA))
        (frame.line(&effect, EFFECT, false))
        @for (x, y) in &data { circle cx=(frame.at_x(*x)) cy=(frame.at_y(*y)) r="2.6" fill=(DATA) {} }
    };
    html! {
        (picture(size, &format!("{y_label} against {x_label}"), &content))
        p.note {
            "Dots with a 95 % band: what the " (words::equation(&shown.equation)) " (" code { (shown.equation) } ") of the fitted "
            "model lacks when this effect is taken out of it, on the validation recordings. Line: what the fitted effect gives. "
            "Where the dots leave the line, the recordings ask for something else."
        }
    }
}
