//! Values between samples.

/// Linear interpolation of `values` over the strictly increasing `time` at `at` (same unit as `time`), held constant
/// outside. `NaN` values are not interpolated over: the result is `NaN` when a neighbour is. Empty input gives `NaN`.
pub fn linear(time: &[f64], values: &[f64], at: f64) -> f64 {
    let Some(last) = time.len().checked_sub(1) else {
        return f64::NAN;
    };
    let after = time.partition_point(|&t| t <= at);
    if after == 0 {
        return values[0];
    }
    if after > last {
        return values[last];
    }
    let before = after - 1;
    let fraction = (at - time[before]) / (time[after] - time[before]);
    if fraction == 0.0 {
        return values[before];
    }
    values[before] + fraction * (values[after] - values[before])
}

/// The value of the latest sample at or before `at`; `NaN` before the first.
pub fn zero_order_hold(time: &[f64], values: &[f64], at: f64) -> f64 {
    match time.partition_point(|&t| t <= at) {
        0 => f64::NAN,
        after => values[after - 1],
    }
}
