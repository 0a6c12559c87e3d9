//! Slopes of noisy signals on an uneven clock.

/// Fewest values for a slope: a parabola has three coefficients, and one more value averages.
const FEWEST: usize = 4;

/// Slope at `centre` of the least-squares parabola through `points` (time in s, value). Values that are not finite are
/// skipped. `NaN` with fewer than four values, or if all are on one side: a one-sided parabola's slope is five times
/// as noisy and lags.
pub(super) fn slope_at(points: impl Iterator<Item = (f64, f64)>, centre: f64) -> f64 {
    let (mut count, mut before, mut after) = (0_usize, false, false);
    // Sums of powers of time, and of the value times powers of time, about the centre.
    let (mut s, mut m) = ([0.0_f64; 5], [0.0_f64; 3]);
    let mut scale = 0.0_f64;
    let points: Vec<(f64, f64)> =
        points.map(|(time, value)| (time - centre, value)).filter(|(_, value)| value.is_finite()).collect();
    for (time, _) in &points {
        scale = scale.max(time.abs());
    }
    if points.len() < FEWEST || scale == 0.0 {
        return f64::NAN;
    }
    let mean = points.iter().map(|(_, value)| value).sum::<f64>() / points.len() as f64;
    for (time, value) in points {
        let t = time / scale;
        let powers = [1.0, t, t * t, t * t * t, t * t * t * t];
        powers.iter().zip(&mut s).for_each(|(power, sum)| *sum += power);
        powers.iter().zip(&mut m).for_each(|(power, sum)| *sum += power * (value - mean));
        count += 1;
        before |= t < 0.0;
        after |= t > 0.0;
    }
    if count < FEWEST || !before || !after {
        return f64::NAN;
    }
    // Cramer's rule for the middle coefficient of [s0 s1 s2; s1 s2 s3; s2 s3 s4] c = m.
    let determinant =
        s[0] * (s[2] * s[4] - s[3] * s[3]) - s[1] * (s[1] * s[4] - s[3] * s[2]) + s[2] * (s[1] * s[3] - s[2] * s[2]);
    let middle =
        s[0] * (m[1] * s[4] - s[3] * m[2]) - m[0] * (s[1] * s[4] - s[3] * s[2]) + s[2] * (s[1] * m[2] - m[1] * s[2]);
    if determinant.abs() < 1e-9 { f64::NAN } else { middle / determinant / scale }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parabolas_are_differentiated_exactly_on_any_clock() {
        let times = [-0.010, -0.0073, -0.002, 0.0, 0.001, 0.004, 0.0099];
        let value = |t: f64| 3.0 + 2.0 * t - 40.0 * t * t;
        let slope = slope_at(times.iter().map(|&t| (5.0 + t, value(t))), 5.0);
        assert!((slope - 2.0).abs() < 1e-9, "{slope}");
    }

    #[test]
    fn missing_values_are_left_out() {
        let times = (-10..=10).map(|k| f64::from(k) * 1e-3);
        let slope = slope_at(times.map(|t| (t, if t == 0.0 { f64::NAN } else { 7.0 * t })), 0.0);
        assert!((slope - 7.0).abs() < 1e-9);
    }

    #[test]
    fn one_sided_or_few_values_have_no_slope() {
        assert!(slope_at((0..=10).map(|k| (f64::from(k), 1.0)), 0.0).is_nan());
        assert!(slope_at([(-1.0, 1.0), (0.0, 1.0), (1.0, 1.0)].into_iter(), 0.0).is_nan());
        assert!(slope_at([(0.0, 1.0); 9].into_iter(), 0.0).is_nan());
    }
}
