//! Small still pictures: a frame with axes, and points in it.

use std::fmt::Write;

use maud::{Markup, PreEscaped, html};

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
    /// Where `x` is in the picture.
    pub fn at_x(&self, x: f64) -> f64 {
        let (left, right, ..) = self.margins;
        left + (x - self.x.0) / (self.x.1 - self.x.0) * (self.size.0 - left - right)
    }

    /// Where `y` is in the picture.
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
        html! {
            @for tick in ticks(self.x, 5) {
                line.grid x1=(short(self.at_x(tick))) x2=(short(self.at_x(tick))) y1=(low) y2=(high) {}
                text x=(short(self.at_x(tick))) y=(low + 15.0) text-anchor="middle" { (tick_text(tick, self.x)) }
            }
            @for tick in ticks(self.y, 5) {
                line.grid x1=(left) x2=(end) y1=(short(self.at_y(tick))) y2=(short(self.at_y(tick))) {}
                text x=(left - 6.0) y=(short(self.at_y(tick) + 3.5)) text-anchor="end" { (tick_text(tick, self.y)) }
            }
            @if self.holds(self.x.0, 0.0) {
                line.zero x1=(left) x2=(end) y1=(short(self.at_y(0.0))) y2=(short(self.at_y(0.0))) {}
            }
            line.axis x1=(left) x2=(end) y1=(low) y2=(low) {}
            line.axis x1=(left) x2=(left) y1=(low) y2=(high) {}
            text.label x=(short((left + end) / 2.0)) y=(self.size.1 - 5.0) text-anchor="middle" { (x_label) }
            text.label x="2" y="12" { (y_label) }
        }
    }

    /// A line through points `(x, y)`.
    pub fn line(&self, points: &[(f64, f64)], colour: &str, dashed: bool) -> Markup {
        let dash = if dashed { r#" stroke-dasharray="6 3""# } else { "" };
        PreEscaped(format!(
            r#"<polyline points="{}" fill="none" stroke="{colour}" stroke-width="1.8" stroke-linejoin="round"{dash}></polyline>"#,
            self.path(points.iter().copied())
        ))
    }

    /// A band between `(x, low, high)`.
    pub fn band(&self, points: &[(f64, f64, f64)], colour: &str) -> Markup {
        let upper = points.iter().map(|&(x, _, high)| (x, high));
        let lower = points.iter().rev().map(|&(x, low, _)| (x, low));
        PreEscaped(format!(
            r#"<polygon points="{}" fill="{colour}" fill-opacity="0.16"></polygon>"#,
            self.path(upper.chain(lower))
        ))
    }

    /// Small dots where points are inside.
    pub fn dots(&self, points: &[(f64, f64)], colour: &str) -> Markup {
        let mut path = String::new();
        for &(x, y) in points.iter().filter(|(x, y)| self.holds(*x, *y)) {
            let _ = write!(path, "M{} {}h0", short(self.at_x(x)), short(self.at_y(y)));
        }
        PreEscaped(format!(
            r#"<path d="{path}" stroke="{colour}" stroke-opacity="0.28" stroke-width="2.4" stroke-linecap="round" fill="none"></path>"#
        ))
    }

    fn path(&self, points: impl Iterator<Item = (f64, f64)>) -> String {
        let mut path = String::new();
        for (x, y) in points.filter(|(x, y)| x.is_finite() && y.is_finite()) {
            let y = y.clamp(self.y.0, self.y.1);
            let _ = write!(path, "{},{} ", short(self.at_x(x)), short(self.at_y(y)));
        }
        path.trim_end().to_string()
    }
}

/// The picture around what is drawn.
pub(super) fn picture(size: (f64, f64), description: &str, content: &Markup) -> Markup {
    let (width, height) = size;
    html! {
        svg.figure viewBox=(format!("0 0 {width} {height}")) width=(width) height=(height) role="img" aria-label=(description) { (content) }
    }
}

/// Coordinates need no more than a tenth of a pixel.
pub(super) fn short(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

/// Round numbers inside a range, about `wanted` of them.
fn ticks(range: (f64, f64), wanted: usize) -> Vec<f64> {
    let step = tick_step(range, wanted);
    if !(step.is_finite() && step > 0.0) {
        return Vec::new();
    }
    let (first, last) = ((range.0 / step).ceil() as i64, (range.1 / step).floor() as i64);
    (first..=last).take(4 * wanted).map(|index| index as f64 * step).collect()
}

/// A round step with about `wanted` ticks in the range, and two at least.
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

fn tick_text(tick: f64, range: (f64, f64)) -> String {
    let step = tick_step(range, 5);
    let largest = range.0.abs().max(range.1.abs());
    if !(1e-4..1e6).contains(&largest) {
        return format!("{tick:.1e}").replace('-', "−");
    }
    let decimals = (-step.log10().floor()).max(0.0) as usize;
    format!("{tick:.decimals$}").replace('-', "−")
}

/// A range that holds all values with some room; around zero and of size one for none.
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
        assert_eq!(tick_text(-0.5, (-1.1, 1.1)), "−0.5");
        assert!(ticks((f64::NAN, 1.0), 5).is_empty());
        assert_eq!(range_of([f64::NAN].into_iter()), (-0.5, 0.5));
        let (low, high) = range_of([3.0, 3.0].into_iter());
        assert!(low < 3.0 && high > 3.0);
    }
}
