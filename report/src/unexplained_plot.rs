//! Plots the residual that no effect of the catalogue explains, as a curve.

use excavator_identification::diagnosis::Unexplained;
use excavator_model::machine::Machine;
use maud::{Markup, html};

use super::numbers::{SIDES_95, percent};
use super::residual_units::{unit_of_residual, unit_of_variable};
use super::svg::{Frame, picture, range_of};
use super::words;

/// The residual, with its band.
pub(super) fn unexplained_plot(machine: &Machine, left: &Unexplained) -> Markup {
    let (x_unit, y_unit) = (unit_of_variable(machine, &left.equation, &left.variable), unit_of_residual(&left.unit));
    let points: Vec<(f64, f64, f64)> = left
        .curve
        .iter()
        .map(|[x, mean, error]| (x * x_unit.factor, mean * y_unit.factor, error * y_unit.factor))
        .filter(|(x, mean, error)| x.is_finite() && mean.is_finite() && error.is_finite())
        .collect();
    let band: Vec<(f64, f64, f64)> =
        points.iter().map(|&(x, mean, e)| (x, mean - SIDES_95 * e, mean + SIDES_95 * e)).collect();
    let line: Vec<(f64, f64)> = points.iter().map(|&(x, mean, _)| (x, mean)).collect();
    let size = (760.0, 340.0);
    let frame = Frame {
        size,
        margins: (64.0, 12.0, 24.0, 40.0),
        x: range_of(points.iter().map(|point| point.0)),
        y: range_of(band.iter().flat_map(|&(_, low, high)| [low, high, 0.0])),
    };
    let x_label = format!("{} ({})", words::variable(&left.variable), x_unit.symbol);
    let y_label = format!("residual ({})", y_unit.symbol);
    let content = html! {
        (frame.axes(&x_label, &y_label))
        (frame.band(&band, "var(--purple)"))
        (frame.line(&line, "var(--purple)", false))
        @for (x, y) in &line { circle cx=(frame.at_x(*x)) cy=(frame.at_y(*y)) r="2.6" style="fill:var(--purple)" {} }
    };
    html! {
        p {
            "The " (words::equation(&left.equation)) " (" code { (left.equation) } ") is off, and " (percent(left.share_of_residual))
            " of its squared residual follows the " (words::variable(&left.variable))
            ". The curve is the mean residual, measured side minus model, with a 95 % band: whatever is missing has this shape."
        }
        @if line.is_empty() { p.empty { "The curve has no points." } } @else {
            (picture(size, &format!("{y_label} against {x_label}"), &content))
        }
    }
}
