//! Plots the error against variables of the machine: command, speed, pressure, position.

use std::borrow::Cow;

use excavator_identification::validation::Comparison;
use excavator_model::Model;
use excavator_model::recording::{Recording, is_measured};
use maud::{Markup, html};

use super::plot_line::Line;
use super::svg::{Frame, picture, range_of};
use super::units::{self, Unit};
use super::words;

/// Number of bins along the variable.
const BINS: usize = 32;

/// Samples that a bin needs to have a mean.
const LEAST_SAMPLES: usize = 8;

/// Dots of one picture.
const DOTS: usize = 350;

/// Size of one picture.
const SIZE: (f64, f64) = (265.0, 205.0);

/// Errors of one model on all recordings.
pub(super) struct Errors<'a> {
    /// How it is drawn.
    pub line: Line,
    /// Its comparisons.
    pub comparisons: &'a [Comparison],
}

/// A variable of the machine, in display units.
struct Variable<'a> {
    label: String,
    unit: Unit<'a>,
    values: Cow<'a, [f64]>,
}

/// Samples of one model in one picture, and their means.
struct Cloud {
    line: Line,
    points: Vec<(f64, f64)>,
    means: Vec<(f64, f64, f64)>,
}

/// One picture per variable for every signal.
pub(super) fn error_plots(model: &Model, models: &[Errors<'_>]) -> Markup {
    let mut names: Vec<&str> = Vec::new();
    for signal in models.iter().flat_map(|model| model.comparisons).flat_map(|comparison| &comparison.signals) {
        if !names.contains(&signal.name.as_str()) {
            names.push(&signal.name);
        }
    }
    html! {
        p.note {
            "Lines are means of the error (measured − model) over bins of the variable, bands are one standard deviation "
            "around them" @if models.len() == 1 { ", dots are single samples" }
            ". A flat line at zero is a model that misses nothing here; a kink, step or slope shows where physics is missing."
        }
        @if models.len() > 1 {
            div.key { @for model in models { span style={ "--swatch:" (model.line.colour) } { (model.line.label) } } }
        }
        @if names.is_empty() { p.empty { "No signal to plot." } }
        @for name in names {
            div.signal {
                h3 { (words::signal(name)) small { code { (name) } } }
                (panels(model, name, models))
            }
        }
    }
}

fn panels(model: &Model, name: &str, models: &[Errors<'_>]) -> Markup {
    let unit = units::of_signal(&model.machine, name);
    let labels: Vec<String> = models
        .iter()
        .flat_map(|errors| errors.comparisons)
        .next()
        .map(|comparison| variables(model, name, &comparison.measured))
        .unwrap_or_default()
        .into_iter()
        .map(|variable| format!("{} ({})", variable.label, variable.unit.symbol))
        .collect();
    let panels: Vec<(String, Vec<Cloud>)> = labels
        .into_iter()
        .enumerate()
        .map(|(index, label)| {
            (label, models.iter().filter_map(|errors| cloud(model, name, index, errors, unit)).collect::<Vec<Cloud>>())
        })
        .filter(|(_, clouds)| !clouds.is_empty())
        .collect();
    let levels = panels
        .iter()
        .flat_map(|(_, clouds)| clouds)
        .flat_map(|cloud| cloud.means.iter().flat_map(|(_, mean, spread)| [mean - spread, mean + spread, 0.0]));
    let y = range_of(levels);
    html! {
        @if panels.is_empty() { p.empty { "Nothing is measured to plot this error against." } }
        div.panels {
            @for (label, clouds) in &panels { (panel(label, clouds, y, &format!("error ({})", unit.symbol))) }
        }
    }
}

fn panel(label: &str, clouds: &[Cloud], y: (f64, f64), y_label: &str) -> Markup {
    let x = range_of(clouds.iter().flat_map(|cloud| cloud.means.iter().map(|mean| mean.0)));
    let frame = Frame { size: SIZE, margins: (46.0, 8.0, 20.0, 36.0), x, y };
    let content = html! {
        (frame.axes(label, y_label))
        @if let [only] = clouds {
            @let stride = only.points.len().div_ceil(DOTS).max(1);
            (frame.dots(&only.points.iter().copied().step_by(stride).collect::<Vec<_>>(), "var(--slate)"))
        }
        @for cloud in clouds {
            (frame.band(&cloud.means.iter().map(|&(x, m, s)| (x, m - s, m + s)).collect::<Vec<_>>(), cloud.line.colour))
        }
        @for cloud in clouds {
            (frame.line(&cloud.means.iter().map(|&(x, m, _)| (x, m)).collect::<Vec<_>>(), cloud.line.colour, cloud.line.dashed))
        }
    };
    picture(SIZE, &format!("{y_label} against {label}"), &content)
}

fn cloud(model: &Model, name: &str, index: usize, errors: &Errors<'_>, unit: Unit) -> Option<Cloud> {
    let mut points = Vec::new();
    for comparison in errors.comparisons {
        let (Some(measured), Some(simulated)) = (comparison.measured.signal(name), comparison.simulated.signal(name))
        else {
            continue;
        };
        let variables = variables(model, name, &comparison.measured);
        let Some(variable) = variables.get(index) else { continue };
        points.extend(
            variable
                .values
                .iter()
                .zip(measured.iter().zip(simulated))
                .map(|(x, (m, s))| (x * variable.unit.factor, (m - s) * unit.factor))
                .filter(|(x, error)| x.is_finite() && error.is_finite()),
        );
    }
    let means = means(&points);
    (means.len() > 1).then_some(Cloud { line: errors.line, points, means })
}

/// Mean and standard deviation over bins of equal width; the outermost half percent on each side is left out.
fn means(points: &[(f64, f64)]) -> Vec<(f64, f64, f64)> {
    let mut sorted: Vec<f64> = points.iter().map(|point| point.0).collect();
    sorted.sort_by(f64::total_cmp);
    let at = |fraction: f64| sorted.get((fraction * sorted.len().saturating_sub(1) as f64) as usize).copied();
    let (Some(low), Some(high)) = (at(0.005), at(0.995)) else { return Vec::new() };
    if high <= low {
        return Vec::new();
    }
    let mut sums = vec![(0_usize, 0.0, 0.0, 0.0); BINS];
    for &(x, error) in points.iter().filter(|point| (low..=high).contains(&point.0)) {
        let bin = (((x - low) / (high - low) * BINS as f64) as usize).min(BINS - 1);
        if let Some(sum) = sums.get_mut(bin) {
            *sum = (sum.0 + 1, sum.1 + x, sum.2 + error, sum.3 + error * error);
        }
    }
    sums.into_iter()
        .filter(|sum| sum.0 >= LEAST_SAMPLES)
        .map(|(count, x, error, squared)| {
            let count = count as f64;
            let mean = error / count;
            (x / count, mean, (squared / count - mean * mean).max(0.0).sqrt())
        })
        .collect()
}

/// The variables that the error of a signal is plotted against. Their number is always the same for the same model and
/// signal.
fn variables<'a>(model: &Model, name: &str, recording: &'a Recording) -> Vec<Variable<'a>> {
    let own = name.split_once('.').map(|(cylinder, _)| cylinder);
    let several = model.machine.cylinders.len() > 1;
    let mut found = Vec::new();
    for cylinder in model.machine.cylinders.iter().filter(|c| own.is_none_or(|own| own == c.name)) {
        let Ok(signals) = recording.cylinder(&cylinder.name) else { continue };
        let labelled = |label: &str| {
            if own.is_none() && several { format!("{} {label}", cylinder.name) } else { label.to_string() }
        };
        let mut push = |label: &str, unit: Unit<'static>, values: &'a [f64]| {
            found.push(Variable { label: labelled(label), unit, values: Cow::Borrowed(values) });
        };
        if cylinder.chambers.is_none() {
            push("rod force", units::KILONEWTON, &signals.rod_force);
        } else if is_measured(&signals.orifice_area) {
            push("valve opening", units::of_opening(Some(cylinder)), &signals.orifice_area);
        } else {
            push("commanded opening", units::of_opening(Some(cylinder)), &signals.orifice_command);
        }
        push("speed", units::of_speed(Some(cylinder)), &signals.velocity);
        if cylinder.chambers.is_some() && own.is_some() {
            match name.ends_with("rod_pressure") {
                true => push("rod pressure", units::pressure(), &signals.rod_pressure),
                false => push("cap pressure", units::pressure(), &signals.cap_pressure),
            }
        }
        if own.is_some() || !several {
            push("position", units::of_position(Some(cylinder)), &signals.displacement);
        }
    }
    if own.is_none() {
        let values = Cow::Borrowed(recording.pump_pressure.as_slice());
        found.push(Variable { label: "pump pressure".to_string(), unit: units::pressure(), values });
    }
    found
}
