//! Evidence from the numbers themselves.

use super::super::unit::Dimension;

/// Extremes and mean of finite values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shape {
    pub least: f64,
    pub most: f64,
    pub mean: f64,
}

impl Shape {
    /// `None` without any finite value.
    pub fn of(values: &[f64]) -> Option<Shape> {
        let mut shape = Shape { least: f64::INFINITY, most: f64::NEG_INFINITY, mean: 0.0 };
        let mut count = 0.0;
        for &value in values.iter().filter(|value| value.is_finite()) {
            shape.least = shape.least.min(value);
            shape.most = shape.most.max(value);
            count += 1.0;
            shape.mean += (value - shape.mean) / count;
        }
        (count > 0.0).then_some(shape)
    }

    /// Whether the values never change.
    pub fn is_constant(&self) -> bool {
        self.most - self.least <= 1e-9 * self.most.abs().max(self.least.abs())
    }

    /// The most likely unit for numbers of this size, and the reason; `None` if they fit SI.
    pub fn unit(&self, dimension: Dimension) -> Option<(&'static str, String)> {
        let size = self.most.abs().max(self.least.abs());
        let most = short(size);
        match dimension {
            // Zero is the same in every unit.
            _ if size == 0.0 => None,
            // No machine has a stroke of 5 m, or a stroke that stays within 5 mm.
            Dimension::Length if size > 5.0 => Some(("mm", format!("numbers up to {most} are no metres"))),
            Dimension::Velocity if size > 10.0 => {
                Some(("mm/s", format!("numbers up to {most} are no metres per second")))
            }
            Dimension::Pressure if size < 1e3 => Some(("bar", format!("values up to {most} are too small for Pa"))),
            Dimension::Pressure if size < 5e4 => {
                Some(("kPa", format!("values up to {most} are too small for Pa and large for bar")))
            }
            Dimension::Angle if size > 7.0 => {
                Some(("deg", format!("numbers up to {most} are more than a turn in radians")))
            }
            Dimension::Flow if size > 0.1 => Some(("l/min", format!("numbers up to {most} are no m3/s"))),
            // A valve of 5 A is a heater; 5 mA is the null of a servo valve.
            Dimension::Current if size > 5.0 => Some(("mA", format!("numbers up to {most} are no amperes of a valve"))),
            Dimension::Area if size > 0.1 => Some(("mm2", format!("numbers up to {most} are no m2"))),
            Dimension::Temperature if self.least > 200.0 => {
                Some(("K", format!("numbers from {} are no oil in degC", short(self.least))))
            }
            _ => None,
        }
    }
}

/// The command value at which a valve rests, if it is not zero, and the share of time at rest. A released lever gives
/// the same number repeatedly, and others on both sides of it.
pub(super) fn rest(values: &[f64]) -> Option<(f64, f64)> {
    let mut known: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    known.sort_by(f64::total_cmp);
    let (least, most) = (*known.first()?, *known.last()?);
    let longest = known.chunk_by(|one, other| one == other).max_by_key(|same| same.len())?;
    let (value, share) = (*longest.first()?, longest.len() as f64 / known.len() as f64);
    let to_both_sides = (value - least).min(most - value) > BOTH_SIDES * (most - least);
    (share >= LEAST_REST && to_both_sides && value.abs() > 0.02 * (most - least)).then_some((value, share))
}

/// Minimum share of time at rest.
const LEAST_REST: f64 = 0.3;
/// Minimum share of the command range on each side of the rest value.
const BOTH_SIDES: f64 = 0.1;

/// A number with three digits.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || (0.01..1e4).contains(&value.abs()) {
        let digits = (2 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 4) as usize;
        return format!("{value:.digits$}");
    }
    format!("{value:.2e}")
}

/// How well `velocity` matches the derivative of `position` (each with its times in s): the correlation, and units of
/// position per second for one unit of velocity. `None` if there is too little motion.
pub(super) fn derivative(position: (&[f64], &[f64]), velocity: (&[f64], &[f64])) -> Option<(f64, f64)> {
    let ((time, x), (other_time, v)) = (position, velocity);
    // Wide steps, so that position noise does not mask the motion.
    let stride = (x.len() / 2000).max(3);
    let (mut products, mut slopes, mut speeds) = (0.0, 0.0, 0.0);
    let mut count = 0;
    for from in (0..x.len().saturating_sub(stride)).step_by(stride) {
        let to = from + stride;
        let middle = 0.5 * (time[from] + time[to]);
        let speed = excavator_model::recording::linear(other_time, v, middle);
        let slope = (x[to] - x[from]) / (time[to] - time[from]);
        if slope.is_finite() && speed.is_finite() {
            products += slope * speed;
            slopes += slope * slope;
            speeds += speed * speed;
            count += 1;
        }
    }
    let size = (slopes * speeds).sqrt();
    (count >= 20 && size > 0.0).then(|| (products / size, products / speeds))
}
