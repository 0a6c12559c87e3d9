//! Plots energies and powers over time, with error bands.

use excavator_identification::results::thinned;
use maud::{Markup, html};

use super::numbers::SIDES_95;
use super::plot_gaps::gaps;
use super::plot_json::{array, shortest, text};
use super::time_plots::plot_box;

/// One line of a plot.
pub(super) struct PowerLine<'a> {
    /// In the legend.
    pub label: &'a str,
    /// CSS colour.
    pub colour: &'a str,
    /// Width, px.
    pub width: f64,
    /// Dashed, so that lines differ without colour.
    pub dashed: bool,
    /// Values.
    pub values: &'a [f64],
    /// Standard errors; drawn as a band of two on each side.
    pub errors: Option<&'a [f64]>,
}

/// One plot.
pub(super) struct PowerPlot<'a> {
    /// Plots of a group are zoomed together.
    pub group: &'a str,
    /// Label of the axis.
    pub label: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// px.
    pub height: usize,
    /// Whether it has the time axis below it.
    pub last: bool,
    /// Largest number of points of a line.
    pub budget: usize,
}

impl PowerPlot<'_> {
    /// The plot of lines over `time`.
    pub fn markup(&self, time: &[f64], lines: &[PowerLine<'_>]) -> Markup {
        let drawn: Vec<&PowerLine<'_>> =
            lines.iter().filter(|line| line.values.iter().any(|value| value.is_finite())).collect();
        if drawn.is_empty() {
            return html! { p.empty { "No values to plot." } };
        }
        let guides: Vec<&[f64]> = drawn.iter().map(|line| line.values).collect();
        let kept = thinned(&guides, time.len(), self.budget * guides.len());
        let (mut series, mut bands) = (Vec::new(), Vec::new());
        for line in &drawn {
            if let Some(errors) = line.errors.filter(|errors| errors.iter().any(|error| error.is_finite())) {
                let edge = |side: f64| -> Vec<f64> {
                    line.values.iter().zip(errors).map(|(value, error)| value + side * SIDES_95 * error).collect()
                };
                let number = series.len();
                bands.push(format!(r#"{{"high":{number},"low":{},"fill":"{}"}}"#, number + 1, line.colour));
                for (side, label) in [(1.0, "95 %, upper"), (-1.0, "95 %, lower")] {
                    let label = format!("{} {label}", line.label);
                    series.push(one(&label, "transparent", 0.0, r#","edge":true"#, &edge(side), &kept));
                }
            }
            let style = if line.dashed { r#","dash":[6,3]"# } else { "" };
            series.push(one(line.label, line.colour, line.width, style, line.values, &kept));
        }
        let seconds: Vec<String> =
            kept.iter().filter_map(|&index| time.get(index)).map(|t| shortest(&format!("{t:.4}"))).collect();
        let json = format!(
            r#"{{"group":{},"label":{},"unit":{},"height":{},"last":{},"gaps":{:?},"time":[{}],"bands":[{}],"series":[{}]}}"#,
            text(self.group),
            text(self.label),
            text(self.unit),
            self.height,
            self.last,
            gaps(time, &kept),
            seconds.join(","),
            bands.join(","),
            series.join(",")
        );
        let labels: Vec<&str> = drawn.iter().map(|line| line.label).collect();
        plot_box(&format!("{} over time: {}", self.label, labels.join(", ")), &json)
    }
}

fn one(label: &str, colour: &str, width: f64, style: &str, values: &[f64], kept: &[usize]) -> String {
    format!(
        r#"{{"label":{},"colour":"{colour}","width":{width}{style},"values":{}}}"#,
        text(label),
        array(values, 1.0, kept)
    )
}
