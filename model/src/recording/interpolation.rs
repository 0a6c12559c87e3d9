//! Values between samples.

/// Linear interpolation of `values` over the strictly increasing `time` at `at` (same unit as `time`), constant outside.
/// It does not bridge `NaN` values: the result is `NaN` if a neighbour is. Empty input gives `NaN`.
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

/// Cubic through the four samples around `at` (Lagrange), on an even or uneven clock. A straight line if only the two
/// nearest are measured; `NaN` if one of these is not, and outside the samples.
pub fn cubic(time: &[f64], values: &[f64], at: f64) -> f64 {
    let (Some(&first), Some(&last)) = (time.first(), time.last()) else {
        return f64::NAN;
    };
    if !(first..=last).contains(&at) {
        return f64::NAN;
    }
    let after = time.partition_point(|&t| t <= at);
    if after < 2 || after + 1 >= time.len() || values[after - 2..after + 2].iter().any(|value| !value.is_finite()) {
        return linear(time, values, at);
    }
    let nodes = after - 2..after + 2;
    nodes
        .clone()
        .map(|node| {
            let others = nodes.clone().filter(|&other| other != node);
            let weight: f64 = others.map(|other| (at - time[other]) / (time[node] - time[other])).product();
            weight * values[node]
        })
        .sum()
}

/// The value of the latest sample at or before `at`; `NaN` before the first.
pub fn zero_order_hold(time: &[f64], values: &[f64], at: f64) -> f64 {
    match time.partition_point(|&t| t <= at) {
        0 => f64::NAN,
        after => values[after - 1],
    }
}

/// The signal with holes bridged by straight lines and constant at the ends; `None` if there is no measured value.
pub(crate) fn without_holes(time: &[f64], signal: &[f64]) -> Option<Vec<f64>> {
    if signal.iter().all(|value| value.is_finite()) {
        return (!signal.is_empty()).then(|| signal.to_vec());
    }
    let (known_time, known): (Vec<f64>, Vec<f64>) =
        time.iter().zip(signal).filter(|(_, value)| value.is_finite()).map(|(&t, &value)| (t, value)).unzip();
    if known.is_empty() {
        return None;
    }
    Some(time.iter().map(|&t| linear(&known_time, &known, t)).collect())
}
