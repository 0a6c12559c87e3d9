//! Small static pictures: a frame with axes, and points in it.

use std::fmt::Write;

use maud::{Markup, PreEscaped, html};

use super::numbers::{exponent_in, power_of_ten};

/// Width of a character of a tick label, px.
const CHARACTER: f64 = 6.2;

/// Smallest distance between two tick labels, px.
const SPACE: f64 = 8.0;

/// Largest number of labelled ticks requested for an axis.
const MOST_TICKS: usize = 5;

/// Width up to which a picture fits on a narrow screen, px.
const NARROW: f64 = 360.0;

/// A rectangle of data drawn into a rectangle of the page.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    /// Size of the picture.
    pub size: (f64, f64),
    /// Space left of, right of, above and below the data.
    pub margins: (f64, f64, f64, f64),
    /// Range of the data from left to right.
    pub x: (f64, f64),
    /// Range of the data from bottom to top.
    pub y: (f64, f64),
}

impl Frame {
    /// Horizontal position of `x` in the picture.
    pub fn at_x(&self, x: f64) -> f64 {
        let (left, right, ..) = self.margins;
        left + (x - self.x.0) / (self.x.1 - self.x.0) * (self.size.0 - left - right)
    }

    /// Vertical position of `y` in the picture.
    pub fn at_y(&self, y: f64) -> f64 {
        let (_, _, top, bottom) = self.margins;
        self.size.1 - bottom - (y - self.y.0) / (self.y.1 - self.y.0) * (self.size.1 - top - bottom)
    }

    /// Whether a point is inside.
    pub fn holds(&self, x: f64, y: f64) -> bool {
        (self.x.0..=self.x.1).contains(&x) && (self.y.0..=self.y.1).contains(&y)
    }

    /// Grid, tick labels and axis labels.
    pub fn axes(&self, x_label: &str, y_label: &str) -> Markup {
        let (left, right, top, bottom) = self.margins;
        let (low, high) = (self.size.1 - bottom, top);
        let end = self.size.0 - right;
        let (across, up) = (Ticks::across(self.x, end - left), Ticks::of(self.y, MOST_TICKS));
        html! {
            @for (tick, text) in across.labelled() {
                line.grid x1=(short(self.at_x(tick))) x2=(short(self.at_x(tick))) y1=(low) y2=(high) {}
                text x=(short(self.at_x(tick))) y=(low + 15.0) text-anchor="middle" { (text) }
            }
            @for (tick, text) in up.labelled() {
                line.grid x1=(left) x2=(end) y1=(short(self.at_y(tick))) y2=(short(self.at_y(tick))) {}
                text x=(left - 6.0) y=(short(self.at_y(tick) + 3.5)) text-anchor="end" { (text) }
            }
            @if self.holds(self.x.0, 0.0) {
                line.zero x1=(left) x2=(end) y1=(short(self.at_y(0.0))) y2=(short(self.at_y(0.0))) {}
            }
            line.axis x1=(left) x2=(end) y1=(low) y2=(low) {}
            line.axis x1=(left) x2=(left) y1=(low) y2=(high) {}
            text.label x=(short((left + end) / 2.0)) y=(self.size.1 - 5.0) text-anchor="middle" { (with_power(x_label, across.exponent)) }
            text.label x="2" y="12" { (with_power(y_label, up.exponent)) }
        }
    }

    /// A line through points `(x, y)`.
    pub fn line(&self, points: &[(f64, f64)], colour: &str, dashed: bool) -> Markup {
        let dash = if dashed { r#" stroke-dasharray="6 3""# } else { "" };
        PreEscaped(format!(
            r#"<polyline points="{}" fill="none" style="stroke:{colour}" stroke-width="1.8" stroke-linejoin="round"{dash}></polyline>"#,
            self.path(points.iter().copied())
        ))
    }

    /// A band between `(x, low, high)`.
    pub fn band(&self, points: &[(f64, f64, f64)], colour: &str) -> Markup {
        let upper = points.iter().map(|&(x, _, high)| (x, high));
        let lower = points.iter().rev().map(|&(x, low, _)| (x, low));
        PreEscaped(format!(
            r#"<polygon points="{}" style="fill:{colour}" fill-opacity="0.16"></polygon>"#,
            self.path(upper.chain(lower))
        ))
    }

    /// Small dots at the points inside the frame.
    pub fn dots(&self, points: &[(f64, f64)], colour: &str) -> Markup {
        let mut path = String::new();
        for &(x, y) in points.iter().filter(|(x, y)| self.holds(*x, *y)) {
            let _ = write!(path, "M{} {}h0", short(self.at_x(x)), short(self.at_y(y)));
        }
        PreEscaped(format!(
            r#"<path d="{path}" style="stroke:{colour}" stroke-opacity="0.28" stroke-width="2.4" stroke-linecap="round" fill="none"></path>"#
        ))
    }

    fn path(&self, points: impl Iterator<Item = (f64, f64)>) -> String {
        let mut path = String::new();
        // Points beyond the axes would cover their labels.
        let room = 1e-6 * (self.x.1 - self.x.0);
        let inside = |x: f64| x >= self.x.0 - room && x <= self.x.1 + room;
        for (x, y) in points.filter(|&(x, y)| inside(x) && y.is_finite()) {
            let y = y.clamp(self.y.0, self.y.1);
            let _ = write!(path, "{},{} ", short(self.at_x(x)), short(self.at_y(y)));
        }
        path.trim_end().to_string()
    }
}

/// The picture around its content. A large one scrolls on a narrow screen.
pub(super) fn picture(size: (f64, f64), description: &str, content: &Markup) -> Markup {
    let (width, height) = (short(size.0), short(size.1));
    let drawing = html! {
        svg.figure viewBox=(format!("0 0 {width} {height}")) width=(width) height=(height) role="img" {
            title { (description) }
            (content)
        }
    };
    if width <= NARROW {
        drawing
    } else {
        html! { div.wide { (drawing) } }
    }
}

/// Rounds a coordinate to a tenth of a pixel.
pub(super) fn short(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

/// Labelled ticks of an axis.
struct Ticks {
    values: Vec<f64>,
    texts: Vec<String>,
    /// Power of ten that is left out of the tick labels.
    exponent: i32,
}

impl Ticks {
    /// About `wanted` ticks, at least two.
    fn of(range: (f64, f64), wanted: usize) -> Self {
        let (values, exponent) = (ticks(range, wanted), exponent_of(range));
        let step = tick_step(range, wanted);
        let texts = values.iter().map(|&tick| tick_text(tick, step, exponent)).collect();
        Ticks { values, texts, exponent }
    }

    /// Ticks along a horizontal axis of this many pixels whose labels do not touch.
    fn across(range: (f64, f64), pixels: f64) -> Self {
        let scale = pixels / (range.1 - range.0);
        let fitting = (2..=MOST_TICKS).rev().map(|wanted| Ticks::of(range, wanted)).find(|ticks| ticks.fit(scale));
        fitting.unwrap_or_else(|| Ticks::of(range, 2))
    }

    fn fit(&self, scale: f64) -> bool {
        let longest = self.texts.iter().map(|text| text.chars().count()).max().unwrap_or(0);
        let least = longest as f64 * CHARACTER + SPACE;
        self.values.windows(2).all(|pair| (pair[1] - pair[0]) * scale >= least)
    }

    fn labelled(&self) -> impl Iterator<Item = (f64, &String)> {
        self.values.iter().copied().zip(&self.texts)
    }
}

/// Round numbers inside a range, about `wanted` of them, at least two.
fn ticks(range: (f64, f64), wanted: usize) -> Vec<f64> {
    let step = tick_step(range, wanted);
    if !(step.is_finite() && step > 0.0) {
        return Vec::new();
    }
    let (first, last) = ((range.0 / step).ceil() as i64, (range.1 / step).floor() as i64);
    (first..=last).take(4 * wanted).map(|index| index as f64 * step).collect()
}

/// A round step with about `wanted` ticks in the range, at least two.
fn tick_step(range: (f64, f64), wanted: usize) -> f64 {
    let rough = (range.1 - range.0) / wanted as f64;
    let power = 10_f64.powf(rough.log10().floor());
    let usual = match rough / power {
        ratio if ratio <= 1.0 => power,
        ratio if ratio <= 2.0 => 2.0 * power,
        ratio if ratio <= 5.0 => 5.0 * power,
        _ => 10.0 * power,
    };
    let count = |step: f64| (range.1 / step).floor() - (range.0 / step).ceil() + 1.0;
    let steps = [10.0, 5.0, 2.0, 1.0, 0.5].map(|factor| factor * power);
    steps.into_iter().find(|&step| step <= usual && count(step) >= 2.0).unwrap_or(usual)
}

/// A multiple of three if plain digits would be long, otherwise zero.
fn exponent_of(range: (f64, f64)) -> i32 {
    let largest = range.0.abs().max(range.1.abs());
    if !(largest.is_finite() && largest > 0.0) {
        return 0;
    }
    let exponent = largest.log10().floor() as i32;
    if exponent >= 5 || exponent <= -3 { 3 * exponent.div_euclid(3) } else { 0 }
}

fn tick_text(tick: f64, step: f64, exponent: i32) -> String {
    let power = 10_f64.powi(exponent);
    // A step such as 0.001 that is slightly too small must not need one more decimal.
    let decimals = (-((step / power).log10() + 1e-9).floor()).max(0.0) as usize;
    format!("{:.decimals$}", tick / power).replace('-', "−")
}

/// An axis label with the power of ten that its ticks leave out: "error (MPa)" -> "error (10⁻³ MPa)".
fn with_power(label: &str, exponent: i32) -> String {
    let label = label.strip_suffix(" ()").unwrap_or(label);
    if exponent == 0 {
        return label.to_string();
    }
    let Some((name, unit)) = label.rsplit_once(" (") else { return format!("{label} ({})", power_of_ten(exponent)) };
    // A unit may have a power of its own.
    let own = unit.split_once(' ').and_then(|(power, rest)| Some((exponent_in(power)?, rest)));
    let (power, unit) = own.map_or((exponent, unit), |(own, rest)| (own + exponent, rest));
    if power == 0 { format!("{name} ({unit}") } else { format!("{name} ({} {unit}", power_of_ten(power)) }
}

/// A range that contains all values with some margin. Without values it has size one around zero.
pub(super) fn range_of(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return (-0.5, 0.5);
    }
    let span = high - low;
    if span <= 1e-9 * high.abs().max(1e-300) {
        let half = (0.1 * high.abs()).max(0.5);
        return (low - half, high + half);
    }
    (low - 0.05 * span, high + 0.05 * span)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks((-1.1, 1.1), 5), vec![-1.0, -0.5, 0.0, 0.5, 1.0]);
        assert!(ticks((f64::NAN, 1.0), 5).is_empty());
        assert_eq!(range_of([f64::NAN].into_iter()), (-0.5, 0.5));
        let (low, high) = range_of([3.0, 3.0].into_iter());
        assert!(low < 3.0 && high > 3.0);
    }

    #[test]
    fn an_axis_has_two_labels_at_least_and_none_touch() {
        for low in [-1.03, 0.013, 0.97, 3.3e-7, 99.03] {
            for span in [1.3e-6, 0.0021, 0.19, 1.01, 7.7, 4.2e6] {
                let range = (low, low + span);
                assert!(Ticks::of(range, 5).values.len() >= 2, "{range:?}");
                let across = Ticks::across(range, 211.0);
                assert!(across.values.len() >= 2, "{range:?}");
                assert!(across.values.iter().all(|tick| (range.0..=range.1).contains(tick)), "{range:?}");
            }
        }
        assert!(Ticks::across((-1e-4, 1e-4), 211.0).fit(211.0 / 2e-4));
    }

    #[test]
    fn long_numbers_give_their_power_to_the_label() {
        let texts = |range| Ticks::of(range, 5).texts;
        assert_eq!(texts((-1.1, 1.1)), ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(texts((-1.2e-4, 2.2e-4)), ["−100", "0", "100", "200"]);
        assert_eq!(exponent_of((-1.2e-4, 2.2e-4)), -6);
        assert_eq!(texts((0.0, 4.1e6)), ["0", "1", "2", "3", "4"]);
        assert_eq!(with_power("error (MPa)", -6), "error (10⁻⁶ MPa)");
        assert_eq!(with_power("opening (mm²), to tank", 3), "opening (10³ mm²), to tank");
        assert_eq!(with_power("gain (10⁻³ m/(s √Pa))", -3), "gain (10⁻⁶ m/(s √Pa))");
        assert_eq!(with_power("flow (10⁻⁶ m³/(s √Pa))", 6), "flow (m³/(s √Pa))");
        assert_eq!(with_power("share ()", 0), "share");
    }
}
