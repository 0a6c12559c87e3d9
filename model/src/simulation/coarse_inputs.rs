//! An input on a coarser clock.

/// Values at every `stride`-th time whose straight lines come nearest to `values` (least squares over all samples).
///
/// Taking every `stride`-th value itself would cut each corner to the same side: a valve that closes between two kept
/// samples would seem open for too long, and the oil that passes meanwhile is a pressure error that lasts. The nearest
/// lines pass the same oil. They are kept within what the input really was around each time, so that no valve that was
/// closed opens to the other side.
pub(super) fn nearest_lines(time: &[f64], values: &[f64], stride: usize) -> Vec<f64> {
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
    (0..nodes)
        .map(|node| {
            let around =
                &values[(node * stride).saturating_sub(stride)..=(node * stride + stride).min(values.len() - 1)];
            let (low, high) = around
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
            right[node].clamp(low, high)
        })
        .collect()
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

    fn trapezoid(time: f64) -> f64 {
        (5.0 - (time - 0.5137).abs() * 20.0).clamp(0.0, 1.0)
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
    fn the_area_under_a_trapezoid_is_kept_and_it_never_turns_negative() {
        let time: Vec<f64> = (0..1001).map(|k| k as f64 * 0.001).collect();
        let values: Vec<f64> = time.iter().map(|&t| trapezoid(t)).collect();
        let area = |values: &[f64], step: f64| (values.iter().sum::<f64>() - values[0] / 2.0) * step;
        let (nearest, picked) =
            (nearest_lines(&time, &values, 20), values.iter().copied().step_by(20).collect::<Vec<_>>());
        let exact = area(&values, 0.001);
        let (by_lines, by_picking) = (area(&nearest, 0.02) - exact, area(&picked, 0.02) - exact);
        assert!(by_lines.abs() < 0.5 * by_picking.abs(), "{by_lines:e} against {by_picking:e}");
        assert!(nearest.iter().all(|&value| (0.0..=1.0).contains(&value)));
    }

    #[test]
    fn a_held_input_keeps_its_mean() {
        let values = [0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 4.0];
        assert_eq!(interval_means(&values, 3), [1.0 / 3.0, 2.0 / 3.0, 4.0]);
    }
}
