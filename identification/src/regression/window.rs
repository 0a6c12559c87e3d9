//! Test functions of the weak form.

/// A smooth bump `(1 - x²)^4` on `[-1, 1]`. It and its first three derivatives are zero at both ends, so that two
/// partial integrations leave no boundary terms.
fn bump(x: f64) -> [f64; 3] {
    let y = 1.0 - x * x;
    if y <= 0.0 {
        return [0.0; 3];
    }
    let y2 = y * y;
    [y2 * y2, -8.0 * x * y2 * y, -8.0 * y2 * y + 48.0 * x * x * y2]
}

/// One window of samples, starting at `first`, with quadrature weights of the bump and its two derivatives.
#[derive(Debug, Clone)]
pub(super) struct Window {
    pub first: usize,
    /// Centre, s.
    pub centre: f64,
    /// For each sample: weights of value, first and second derivative (s, 1, 1/s).
    pub weights: Vec<[f64; 3]>,
}

/// A time gap longer than this many median intervals inside a window spoils its quadrature.
const LARGEST_GAP: f64 = 4.0;

/// Windows of half width `half_width` every `step` s along `time`, without those across gaps.
pub(super) fn windows(time: &[f64], interval: f64, half_width: f64, step: f64) -> Vec<Window> {
    let mut windows = Vec::new();
    let (Some(&start), Some(&end)) = (time.first(), time.last()) else { return windows };
    let mut centre = start + half_width;
    while centre + half_width <= end {
        let first = time.partition_point(|&t| t <= centre - half_width);
        let last = time.partition_point(|&t| t < centre + half_width);
        let inside = &time[first..last];
        // In a time gap, skip to the last window before the next sample, in whole steps. A gap can be years long.
        let skipped =
            time.get(last).filter(|_| inside.is_empty()).map_or(0.0, |next| (next - half_width - centre) / step);
        if skipped > 1.0 {
            centre += skipped.floor() * step;
            continue;
        }
        let largest_gap = LARGEST_GAP * interval;
        // A gap at an end of the window is not between two samples inside, but it still cuts off the bump. At the ends
        // of the recording a window begins or ends with a sample.
        let is_near = |before: usize, after: usize| match (time.get(before), time.get(after)) {
            (Some(before), Some(after)) => after - before <= largest_gap,
            _ => true,
        };
        let reaches_its_ends = is_near(first.wrapping_sub(1), first) && is_near(last.wrapping_sub(1), last);
        let whole =
            inside.len() >= 8 && reaches_its_ends && inside.windows(2).all(|pair| pair[1] - pair[0] <= largest_gap);
        if whole {
            let weights = inside
                .iter()
                .enumerate()
                .map(|(index, &t)| {
                    // Trapezoidal weights at the actual sample times. The bump vanishes at the ends, so they are exact
                    // there.
                    let before = if index > 0 { t - inside[index - 1] } else { interval };
                    let after = inside.get(index + 1).map_or(interval, |next| next - t);
                    let weight = (before + after) / 2.0;
                    let [value, slope, curvature] = bump((t - centre) / half_width);
                    [value * weight, slope * weight / half_width, curvature * weight / (half_width * half_width)]
                })
                .collect();
            windows.push(Window { first, centre, weights });
        }
        centre += step;
    }
    windows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_window_ends_inside_a_gap() {
        let interval = 1e-3;
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * interval + if k < 2000 { 0.0 } else { 7.3 }).collect();
        let all = windows(&time, interval, 0.25, 0.01);
        assert!(all.len() > 250, "{}", all.len());
        for window in all {
            let sum: f64 = window.weights.iter().map(|[_, slope, _]| slope).sum();
            let size: f64 = window.weights.iter().map(|[_, slope, _]| slope.abs()).sum();
            assert!(sum.abs() < 1e-3 * size, "at {}: slopes add up to {sum}", window.centre);
        }
    }

    #[test]
    fn a_gap_of_years_takes_no_longer_and_leaves_the_windows_as_they_are() {
        // Powers of two keep the times exact on both sides of the gap, which is a whole number of steps.
        let (interval, step) = (1.0 / 512.0, 1.0 / 128.0);
        let clock = |gap: f64| -> Vec<f64> {
            (0..2000).map(|index| f64::from(index) * interval + if index < 1000 { 0.0 } else { gap }).collect()
        };
        // No sample at the edge of a window.
        let half_width = 1.0 / 32.0 + 1.0 / 2048.0;
        let places = |gap: f64| -> Vec<usize> {
            windows(&clock(gap), interval, half_width, step).iter().map(|window| window.first).collect()
        };
        let short = places(1.0);
        // Whoever visits each of the 2^36 places in the gap does not come back.
        assert_eq!(places(f64::from(1 << 29)), short);
        assert!(short.len() > 480, "{}", short.len());
    }
}
