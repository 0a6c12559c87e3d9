//! Plots the errors from step to step.

use maud::{Markup, html};

use super::signal_tables::Stages;
use super::svg::{Frame, picture, short};
use super::words;

/// Colours that are distinguishable with any colour vision (Okabe and Ito), darkest first.
const COLOURS: [&str; 8] = [
    "var(--blue)",
    "var(--orange)",
    "var(--green)",
    "var(--pink)",
    "var(--gold)",
    "var(--sky)",
    "var(--purple)",
    "var(--slate)",
];

/// Smallest distance between two labels, px.
const LABEL_HEIGHT: f64 = 15.0;

/// Width of a character of a label, px.
const CHARACTER: f64 = 6.4;

const WIDTH: f64 = 900.0;
/// Space for the numbers of the axis.
const LEFT: f64 = 64.0;
/// Space for the names of the lines.
const RIGHT: f64 = 200.0;

/// One line per signal, the error on a logarithmic scale.
pub(super) fn step_plot(stages: &Stages) -> Markup {
    let positive =
        || stages.signals.iter().flat_map(|(_, errors)| errors).filter(|error| error.is_finite() && **error > 0.0);
    if stages.names.len() < 2 || positive().next().is_none() {
        return html! { p.empty { "Nothing was changed, so there are no steps to draw." } };
    }
    let low = positive().copied().fold(f64::INFINITY, f64::min).log10().floor();
    let high = positive().copied().fold(0.0, f64::max).log10().ceil().max(low + 1.0);
    let last = (stages.names.len() - 1) as f64;
    let rows = rows_of_names(&stages.names);
    let bottom = 20.0 + LABEL_HEIGHT * rows as f64;
    let size = (WIDTH, 266.0 + bottom);
    let frame = Frame { size, margins: (LEFT, RIGHT, 26.0, bottom), x: (-0.15, last + 0.1), y: (low, high) };
    let decades = (low as i32)..=(high as i32);
    let content = html! {
        text.label x="2" y="12" { "NMSE on validation, logarithmic" }
        @for decade in decades {
            @let y = short(frame.at_y(f64::from(decade)));
            line.grid x1=(LEFT) x2=(size.0 - RIGHT) y1=(y) y2=(y) {}
            text x=(LEFT - 6.0) y=(y + 3.5) text-anchor="end" { (decade_text(decade)) }
        }
        @for (index, name) in stages.names.iter().enumerate() {
            @let x = short(frame.at_x(index as f64));
            line.grid x1=(x) x2=(x) y1="26" y2=(size.1 - bottom) {}
            text.label x=(x) y=(size.1 - bottom + 5.0 + LABEL_HEIGHT * (1 + index % rows) as f64) text-anchor="middle" { (name) }
        }
        @for (number, (_, errors)) in stages.signals.iter().enumerate() {
            @let points = points(errors);
            (frame.line(&points, colour(number), false))
            @for (x, y) in &points { (marker(number, frame.at_x(*x), frame.at_y(*y))) }
        }
        @for (number, y) in label_heights(stages, &frame) {
            (marker(number, size.0 - RIGHT + 18.0, y))
            text.label x=(size.0 - RIGHT + 28.0) y=(short(y + 4.0)) {
                (stages.signals.get(number).map_or(String::new(), |(name, _)| words::signal(name)))
            }
        }
    };
    picture(size, "error of each signal at each step", &content)
}

/// Number of rows for the names of the steps, so that they do not touch.
fn rows_of_names(names: &[String]) -> usize {
    let longest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let spacing = (WIDTH - LEFT - RIGHT) / names.len() as f64;
    ((longest as f64 * CHARACTER / spacing).ceil() as usize).clamp(1, 4)
}

fn points(errors: &[f64]) -> Vec<(f64, f64)> {
    let logarithms = errors.iter().enumerate().map(|(index, error)| (index as f64, error.log10()));
    logarithms.filter(|(_, y)| y.is_finite()).collect()
}

/// Heights of the labels at the lines' ends, moved apart where they would overlap.
fn label_heights(stages: &Stages, frame: &Frame) -> Vec<(usize, f64)> {
    let mut labels: Vec<(usize, f64)> = stages
        .signals
        .iter()
        .enumerate()
        .filter_map(|(number, (_, errors))| Some((number, frame.at_y(points(errors).last()?.1))))
        .collect();
    labels.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut free = f64::NEG_INFINITY;
    for label in &mut labels {
        label.1 = label.1.max(free);
        free = label.1 + LABEL_HEIGHT;
    }
    // Labels below the bottom are moved up again.
    let mut limit = frame.size.1 - frame.margins.3;
    for label in labels.iter_mut().rev() {
        label.1 = label.1.min(limit);
        limit = label.1 - LABEL_HEIGHT;
    }
    labels
}

fn colour(number: usize) -> &'static str {
    COLOURS.get(number % COLOURS.len()).copied().unwrap_or("var(--ink)")
}

fn marker(number: usize, x: f64, y: f64) -> Markup {
    let (x, y) = (short(x), short(y));
    html! {
        @match number % 4 {
            0 => circle cx=(x) cy=(y) r="4" style={ "fill:" (colour(number)) } {},
            1 => rect x=(x - 3.5) y=(y - 3.5) width="7" height="7" style={ "fill:" (colour(number)) } {},
            2 => polygon points=(format!("{x},{} {},{} {},{}", y - 5.0, x - 4.5, y + 3.5, x + 4.5, y + 3.5)) style={ "fill:" (colour(number)) } {},
            _ => polygon points=(format!("{x},{} {},{y} {x},{} {},{y}", y - 5.0, x + 5.0, y + 5.0, x - 5.0)) style={ "fill:" (colour(number)) } {},
        }
    }
}

fn decade_text(decade: i32) -> String {
    match decade {
        -4..=3 => format!("{}", 10_f64.powi(decade)),
        _ => super::numbers::power_of_ten(decade),
    }
}
