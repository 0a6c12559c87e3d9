//! An input on a coarser clock.

/// Values at every `stride`-th time whose straight lines come nearest to `values` (least squares over all samples).
///
/// Taking every `stride`-th value itself would cut each corner to the same side: a valve that closes between two kept
/// samples would seem open for too long, and the oil that passes meanwhile is a pressure error that lasts. The nearest
/// lines pass the same oil. They are kept within what the input really was around each time, so that no valve that was
/// closed opens to the other side; that costs half of what was won at a corner.
pub(super) fn nearest_lines(time: &[f64], values: &[f64], stride: usize) -> Vec<f64> {
    let mut lines = projected(time, values, stride);
    for (node, value) in lines.iter_mut().enumerate() {
        let sample = node * stride;
        let around = &values[sample.saturating_sub(stride)..=(sample + stride).min(values.len() - 1)];
        let (low, high) = around
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
        *value = value.clamp(low, high);
    }
    lines
}

/// Root mean square distance of `values` from the `lines` through every `stride`-th time, as a share of their own spread; zero
/// where they have none.
pub(super) fn missed_share(time: &[f64], values: &[f64], lines: &[f64], stride: usize) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let spread: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let missed = |sample: usize| {
        let node = sample / stride;
        let (Some(from), Some(to)) = (lines.get(node), lines.get(node + 1)) else { return 0.0 };
        let (first, last) = (time[node * stride], time[(node + 1) * stride]);
        values[sample] - (from + (time[sample] - first) / (last - first) * (to - from))
    };
    let squares: f64 = (0..values.len()).map(|sample| missed(sample).powi(2)).sum();
    if spread > 0.0 { (squares / spread).sqrt() } else { 0.0 }
}

/// The nearest lines, wherever they lead.
fn projected(time: &[f64], values: &[f64], stride: usize) -> Vec<f64> {
    let picked: Vec<f64> = values.iter().copied().step_by(stride).collect();
    let nodes = picked.len();
    if stride < 2 || nodes < 2 {
        return picked;
    }
    let (mut diagonal, mut beside, mut right) = (vec![0.0; nodes], vec![0.0; nodes], vec![0.0; nodes]);
    for node in 0..nodes - 1 {
        let (first, last) = (node * stride, (node + 1) * stride);
        let length = time[last] - time[first];
        for sample in first..=last {
            // The ends belong to two pieces, half to each.
            let weight = if sample == first || sample == last { 0.5 } else { 1.0 };
            let to_next = if length > 0.0 { (time[sample] - time[first]) / length } else { 0.0 };
            let to_this = 1.0 - to_next;
            diagonal[node] += weight * to_this * to_this;
            diagonal[node + 1] += weight * to_next * to_next;
            beside[node] += weight * to_this * to_next;
            right[node] += weight * to_this * values[sample];
            right[node + 1] += weight * to_next * values[sample];
        }
    }
    solve_tridiagonal(&mut diagonal, &beside, &mut right);
    right
}

/// Mean over each kept interval: for an input that is held, what passes meanwhile stays the same.
pub(super) fn interval_means(values: &[f64], stride: usize) -> Vec<f64> {
    values.chunks(stride.max(1)).map(|interval| interval.iter().sum::<f64>() / interval.len() as f64).collect()
}

/// Solves a symmetric positive definite tridiagonal system in place (Thomas algorithm); `beside[i]` couples i and i + 1.
fn solve_tridiagonal(diagonal: &mut [f64], beside: &[f64], right: &mut [f64]) {
    for row in 1..diagonal.len() {
        let factor = beside[row - 1] / diagonal[row - 1];
        diagonal[row] -= factor * beside[row - 1];
        right[row] -= factor * right[row - 1];
    }
    for row in (0..diagonal.len()).rev() {
        let after = if row + 1 < diagonal.len() { beside[row] * right[row + 1] } else { 0.0 };
        right[row] = (right[row] - after) / diagonal[row];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.001;
    const STRIDE: usize = 20;

    fn area(values: &[f64], step: f64) -> f64 {
        (values.iter().sum::<f64>() - (values[0] + values[values.len() - 1]) / 2.0) * step
    }

    /// Mean squared distance between the full input and lines on the coarse clock.
    fn distance(values: &[f64], lines: &[f64]) -> f64 {
        let line = |sample: usize| {
            let (node, rest) = ((sample / STRIDE).min(lines.len() - 2), sample);
            let fraction = (rest - node * STRIDE) as f64 / STRIDE as f64;
            lines[node] + fraction * (lines[node + 1] - lines[node])
        };
        (0..values.len()).map(|sample| (values[sample] - line(sample)).powi(2)).sum::<f64>() / values.len() as f64
    }

    #[test]
    fn lines_stay_as_they_are() {
        let time: Vec<f64> = (0..41).map(|k| k as f64 * 0.01).collect();
        let values: Vec<f64> = time.iter().map(|t| 3.0 - 2.0 * t).collect();
        for (node, value) in nearest_lines(&time, &values, 5).into_iter().enumerate() {
            assert!((value - values[node * 5]).abs() < 1e-12);
        }
    }

    #[test]
    fn the_area_under_a_trapezoid_is_kept_wherever_its_corners_are() {
        let time: Vec<f64> = (0..1001).map(|k| k as f64 * STEP).collect();
        for phase in 0..10 {
            let middle = 0.5 + 0.0023 * f64::from(phase);
            let values: Vec<f64> = time.iter().map(|t| (5.0 - (t - middle).abs() * 20.0).clamp(0.0, 1.0)).collect();
            let exact = area(&values, STEP);
            let coarse = |values: &[f64]| area(values, STEP * STRIDE as f64) - exact;
            assert!(coarse(&projected(&time, &values, STRIDE)).abs() < 1e-12);

            let lines = nearest_lines(&time, &values, STRIDE);
            let picked: Vec<f64> = values.iter().copied().step_by(STRIDE).collect();
            assert!(coarse(&lines).abs() < coarse(&picked).abs(), "{} {}", coarse(&lines), coarse(&picked));
            assert!(distance(&values, &lines) < distance(&values, &picked));
            assert!(lines.iter().all(|&value| (0.0..=1.0).contains(&value)));
        }
    }

    #[test]
    fn jumps_are_missed_and_lines_are_not() {
        let time: Vec<f64> = (0..1001).map(|k| k as f64 * STEP).collect();
        let missed = |of: &dyn Fn(f64) -> f64, stride: usize| {
            let values: Vec<f64> = time.iter().map(|&t| of(t)).collect();
            missed_share(&time, &values, &nearest_lines(&time, &values, stride), stride)
        };
        assert!(missed(&|t| 1.0 - 2.0 * t, STRIDE) < 1e-12);
        assert_eq!(missed(&|_| 3.0, STRIDE), 0.0);
        let jump = |t: f64| f64::from(u8::from(t > 0.507));
        // Some two samples of every twenty about the one jump in a second, by up to half of it.
        assert!((0.03..0.1).contains(&missed(&jump, STRIDE)), "{}", missed(&jump, STRIDE));
        assert!(missed(&jump, 1) < 1e-12);
    }

    #[test]
    fn a_held_input_keeps_its_mean() {
        let values = [0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 4.0];
        assert_eq!(interval_means(&values, 3), [1.0 / 3.0, 2.0 / 3.0, 4.0]);
    }
}
