//! Plots measured and simulated signals over time, with the error below on the same axis.

use excavator_identification::results::thinned;
use excavator_identification::validation::{Comparison, SignalComparison};
use excavator_model::recording::is_measured;
use maud::{Markup, PreEscaped, html};

use super::machine_picture::machine_picture;
use super::plot_gaps::gaps;
use super::plot_json::{array, shortest, text};
use super::plot_line::{Line, MEASURED};
use super::units::{self, Unit};
use super::{numbers, words};

/// Largest number of points of one series.
const MOST_POINTS: usize = 2000;

/// Smallest number of points of one series, regardless of the number of series.
const FEWEST_POINTS: usize = 200;

/// Total count of numbers, including times, for all plots of a page. With about six characters each they leave room for
/// the rest of a page of one megabyte.
const NUMBERS_OF_A_PAGE: usize = 75_000;

/// Width of the measured line, px. It lies under the models and must be visible on both sides of them.
const MEASURED_WIDTH: f64 = 4.0;

/// Width of all other lines, px.
const MODEL_WIDTH: f64 = 1.4;

/// Instructions for the plots.
pub(super) fn hint() -> Markup {
    html! {
        p.hint {
            "Drag across a plot to zoom, double-click to zoom out; all plots of one recording move together. Click a name under "
            "a plot to hide its line. With the keyboard: Tab goes to a plot, ← and → move the cursor (with Shift in larger steps), "
            "+ and − zoom around it, and 0 or Escape shows everything."
        }
        noscript { p.empty { "The plots over time are drawn by the script of this page, which is switched off here." } }
    }
}

/// Plots of all signals of one recording under one or more models. `number` identifies the recording among the
/// `recordings` of a page.
pub(super) fn time_plots(models: &[(Line, &Comparison)], number: usize, recordings: usize) -> Markup {
    let Some((_, first)) = models.first() else { return html! { p.empty { "Nothing to compare." } } };
    // Each signal has two plots, each with times: one of the measurement and the models, one of their errors.
    let columns = first.signals.len() * recordings * (2 * models.len() + 3);
    let group = format!("recording-{number}");
    let budget = (NUMBERS_OF_A_PAGE / columns.max(1)).clamp(FEWEST_POINTS, MOST_POINTS);
    html! {
        @if first.signals.is_empty() { p.empty { "This recording measures no output of the model." } }
        (machine_picture(models, &group))
        @for signal in &first.signals {
            div.signal {
                h3 { (words::signal(&signal.name)) small { code { (signal.name) } " · " (caption(models, signal)) } }
                (signal_plots(models, &signal.name, &group, budget))
            }
        }
    }
}

fn caption(models: &[(Line, &Comparison)], signal: &SignalComparison) -> String {
    let error = |comparison: &Comparison| {
        let own = comparison.signals.iter().find(|candidate| candidate.name == signal.name);
        numbers::significant(own.map_or(f64::NAN, |own| own.error.normalised()), 3)
    };
    match models {
        [(_, only)] => format!("NMSE {} · FIT {:.1} %", error(only), signal.error.fit_percent()),
        several => {
            let errors: Vec<String> = several.iter().map(|(line, c)| format!("{} {}", line.label, error(c))).collect();
            format!("NMSE {}", errors.join(", "))
        }
    }
}

fn signal_plots(models: &[(Line, &Comparison)], name: &str, group: &str, budget: usize) -> Markup {
    let nothing = html! { p.empty { "No values to plot." } };
    let Some((_, first)) = models.first() else { return nothing };
    let time = &first.measured.time;
    let Some(measured) = first.measured.signal(name).filter(|values| is_measured(values)) else { return nothing };
    let simulated: Vec<(Line, &[f64])> =
        models.iter().filter_map(|(line, comparison)| Some((*line, comparison.simulated.signal(name)?))).collect();
    let errors: Vec<(Line, Vec<f64>)> = simulated
        .iter()
        .map(|(line, values)| (*line, measured.iter().zip(*values).map(|(m, s)| m - s).collect()))
        .collect();
    let mut guides: Vec<&[f64]> = vec![measured];
    guides.extend(errors.first().map(|(_, values)| values.as_slice()));
    let kept = thinned(&guides, time.len(), budget);
    let unit = units::of_signal(&first.machine, name);
    let mut lines = vec![(MEASURED, measured)];
    lines.extend(simulated.iter().copied());
    let errors: Vec<(Line, &[f64])> = errors.iter().map(|(line, values)| (*line, values.as_slice())).collect();
    let quantity = words::spoken(name.rsplit('.').next().unwrap_or(name));
    let title = words::signal(name);
    let upper = Plot { group, title: &title, label: &quantity, unit, height: 230, last: false, error: false };
    let lower = Plot { group, title: &title, label: "error", unit, height: 150, last: true, error: true };
    html! {
        (upper.markup(time, &lines, &kept))
        (lower.markup(time, &errors, &kept))
    }
}

/// One plot in the format of the page's script.
struct Plot<'a> {
    group: &'a str,
    /// Name of the signal for screen readers.
    title: &'a str,
    label: &'a str,
    unit: Unit<'a>,
    height: usize,
    last: bool,
    error: bool,
}

impl Plot<'_> {
    fn markup(&self, time: &[f64], lines: &[(Line, &[f64])], kept: &[usize]) -> Markup {
        let labels: Vec<String> = lines
            .iter()
            .map(|(line, _)| if self.error { format!("measured − {}", line.label) } else { line.label.to_string() })
            .collect();
        let series: Vec<String> = lines
            .iter()
            .zip(&labels)
            .map(|((line, values), label)| {
                format!(
                    r#"{{"label":{},"colour":"{}","width":{}{},"values":{}}}"#,
                    text(label),
                    line.colour,
                    if line.label == MEASURED.label { MEASURED_WIDTH } else { MODEL_WIDTH },
                    if line.dashed { r#","dash":[6,3]"# } else { "" },
                    array(values, self.unit.factor, kept)
                )
            })
            .collect();
        let seconds: Vec<String> =
            kept.iter().filter_map(|&index| time.get(index)).map(|t| shortest(&format!("{t:.4}"))).collect();
        let json = format!(
            r#"{{"group":{},"label":{},"unit":{},"height":{},"last":{},"gaps":{:?},"time":[{}],"series":[{}]}}"#,
            text(self.group),
            text(self.label),
            text(self.unit.symbol),
            self.height,
            self.last,
            gaps(time, kept),
            seconds.join(","),
            series.join(",")
        );
        let what = if self.error { "error over time" } else { "over time" };
        plot_box(&format!("{} {what}: {}", self.title, labels.join(", ")), &json)
    }
}

/// The box that the page's script draws `json` into. The keyboard moves its cursor, so it is a focusable widget.
/// `description` describes its content.
pub(super) fn plot_box(description: &str, json: &str) -> Markup {
    html! {
        div.time-plot tabindex="0" role="application" aria-roledescription="plot" aria-label=(description) {
            script type="application/json" { (PreEscaped(json)) }
        }
    }
}
