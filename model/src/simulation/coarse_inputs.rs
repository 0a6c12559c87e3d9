//! Resamples an input to a coarser clock.

/// Values at the samples `kept`, in order, whose straight lines are nearest to `values` (least squares over all samples).
///
/// Using the kept values themselves would cut each corner to the same side. A valve that closes between two kept samples
/// would seem open for too long, and the extra oil is a lasting pressure error. The nearest lines pass the same oil. They
/// are limited to the range of the input around each time, so that no closed valve opens to the other side. That limit
/// loses half of the gain at a corner.
pub(super) fn nearest_lines(time: &[f64], values: &[f64], kept: &[usize]) -> Vec<f64> {
    if kept.len() == values.len() {
        return values.to_vec();
    }
    let mut lines = projected(time, values, kept);
    for (node, value) in lines.iter_mut().enumerate() {
        let (before, after) = (kept[node.saturating_sub(1)], kept.get(node + 1).map_or(values.len() - 1, |&next| next));
        let around = &values[before..=after];
        let (low, high) = around
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
        *value = value.clamp(low, high);
    }
    lines
}

/// Largest distance of `values` from the line between the first and the last of them.
pub(super) fn bend(time: &[f64], values: &[f64]) -> f64 {
    let last = values.len() - 1;
    let slope = if last > 0 { (values[last] - values[0]) / (time[last] - time[0]) } else { 0.0 };
    let distance = |(&t, &value): (&f64, &f64)| (value - values[0] - slope * (t - time[0])).abs();
    time.iter().zip(values).map(distance).fold(0.0, f64::max)
}

/// The nearest lines, without limits.
fn projected(time: &[f64], values: &[f64], kept: &[usize]) -> Vec<f64> {
    let nodes = kept.len();
    if nodes < 2 {
        return kept.iter().map(|&sample| values[sample]).collect();
    }
    let (mut diagonal, mut beside, mut right) = (vec![0.0; nodes], vec![0.0; nodes], vec![0.0; nodes]);
    for (node, ends) in kept.windows(2).enumerate() {
        let (first, last) = (ends[0], ends[1]);
        let length = time[last] - time[first];
        for sample in first..=last {
            // The end samples belong to two pieces, half to each.
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

/// Mean from each kept sample to the next: for a held input, the oil volume in between stays the same.
pub(super) fn interval_means(values: &[f64], kept: &[usize]) -> Vec<f64> {
    let ends = kept.iter().skip(1).copied().chain([values.len()]);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    kept.iter().zip(ends).map(|(&first, end)| mean(&values[first..end])).collect()
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

    fn every_twentieth(samples: usize) -> Vec<usize> {
        (0..samples).step_by(STRIDE).collect()
    }

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
        for (node, value) in nearest_lines(&time, &values, &every_twentieth(41)).into_iter().enumerate() {
            assert!((value - values[node * STRIDE]).abs() < 1e-12);
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
            assert!(coarse(&projected(&time, &values, &every_twentieth(1001))).abs() < 1e-12);

            let lines = nearest_lines(&time, &values, &every_twentieth(1001));
            let picked: Vec<f64> = values.iter().copied().step_by(STRIDE).collect();
            assert!(coarse(&lines).abs() < coarse(&picked).abs(), "{} {}", coarse(&lines), coarse(&picked));
            assert!(distance(&values, &lines) < distance(&values, &picked));
            assert!(lines.iter().all(|&value| (0.0..=1.0).contains(&value)));
        }
    }

    #[test]
    fn where_all_samples_are_kept_all_values_are() {
        let time: Vec<f64> = (0..101).map(|k| k as f64 * STEP).collect();
        let values: Vec<f64> = time.iter().map(|t| f64::from(u8::from(*t > 0.0335))).collect();
        let kept: Vec<usize> = (0..=20).step_by(STRIDE).chain(21..=60).chain([80, 100]).collect();
        let lines = nearest_lines(&time, &values, &kept);
        assert!(kept.iter().zip(&lines).all(|(&sample, line)| (values[sample] - line).abs() < 1e-12), "{lines:?}");
    }

    #[test]
    fn a_corner_is_as_far_from_a_line_as_it_sticks_out() {
        let time = [0.0, 0.1, 0.3, 0.4];
        assert!(bend(&time, &[2.0, 2.1, 2.3, 2.4]) < 1e-12);
        assert!((bend(&time, &[2.0, 2.1, 1.3, 2.4]) - 1.0).abs() < 1e-12);
        assert_eq!(bend(&time[..1], &[3.0]), 0.0);
    }

    #[test]
    fn a_held_input_keeps_its_mean() {
        let values = [0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 4.0];
        assert_eq!(interval_means(&values, &[0, 3, 6]), [1.0 / 3.0, 2.0 / 3.0, 4.0]);
        assert_eq!(interval_means(&values, &[0, 3, 4, 6]), [1.0 / 3.0, 1.0, 0.5, 4.0]);
    }
}
