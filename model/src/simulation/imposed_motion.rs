//! Computes the imposed motion of a cylinder from its measured displacement.

use nalgebra::{Matrix3, Vector3};

use crate::equations::ImposedState;
use crate::machine::Cylinder;
use crate::recording::{CylinderSignals, is_measured, without_holes};

/// Half width of the parabolas for rate and acceleration, in samples and in s, whichever is longer.
const HALF_WIDTH: (f64, f64) = (5.0, 0.02);

/// Joint coordinate with its rate and acceleration, and both pressures, at each sample. A side without a measured
/// pressure counts as open to the air. `None` if neither displacement nor joint angle is measured.
pub(super) fn imposed_signals(
    cylinder: &Cylinder,
    signals: &CylinderSignals,
    time: &[f64],
) -> Option<ImposedState<Vec<f64>>> {
    let joint = if is_measured(&signals.displacement) {
        signals.displacement.iter().map(|&s| cylinder.linkage.joint(s)).collect()
    } else {
        signals.joint_angle.clone()
    };
    let joint = without_holes(time, &joint)?;
    let pressure = |signal: &[f64]| without_holes(time, signal).unwrap_or_else(|| vec![0.0; time.len()]);
    let [joint, rate, acceleration] = parabolas(time, &joint);
    Some(ImposedState {
        joint,
        rate,
        acceleration,
        cap_pressure: pressure(&signals.cap_pressure),
        rod_pressure: pressure(&signals.rod_pressure),
    })
}

/// Value, slope and second derivative, at each sample, of the least-squares parabola around it.
fn parabolas(time: &[f64], signal: &[f64]) -> [Vec<f64>; 3] {
    let half_width = (HALF_WIDTH.0 * median_interval(time)).max(HALF_WIDTH.1);
    let mut all = [Vec::new(), Vec::new(), Vec::new()];
    for (index, &centre) in time.iter().enumerate() {
        let first = time.partition_point(|&t| t < centre - half_width);
        let last = time.partition_point(|&t| t <= centre + half_width);
        // A single sample in a pause of the clock has zero rate.
        let [value, slope, bend] =
            parabola(&time[first..last], &signal[first..last], centre, half_width).unwrap_or([signal[index], 0.0, 0.0]);
        all[0].push(value);
        all[1].push(slope);
        all[2].push(bend);
    }
    all
}

fn parabola(time: &[f64], signal: &[f64], centre: f64, half_width: f64) -> Option<[f64; 3]> {
    if time.len() < 4 {
        return None;
    }
    let origin = signal[0];
    let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (&t, &value) in time.iter().zip(signal) {
        // In units of the half width, so that the normal equations are well conditioned.
        let x = (t - centre) / half_width;
        let powers = Vector3::new(1.0, x, x * x);
        matrix += powers * powers.transpose();
        right += powers * (value - origin);
    }
    let solution = matrix.cholesky()?.solve(&right);
    Some([solution[0] + origin, solution[1] / half_width, 2.0 * solution[2] / (half_width * half_width)])
}

fn median_interval(time: &[f64]) -> f64 {
    let mut intervals: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if intervals.is_empty() {
        return 0.0;
    }
    let middle = intervals.len() / 2;
    *intervals.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_has_its_own_slope_and_bend() {
        let time: Vec<f64> = (0..200).map(|k| 0.01 * f64::from(k) + if k % 3 == 0 { 0.002 } else { 0.0 }).collect();
        let signal: Vec<f64> = time.iter().map(|t| 0.3 - 0.2 * t + 0.05 * t * t).collect();
        let [value, slope, bend] = parabolas(&time, &signal);
        for (index, &t) in time.iter().enumerate() {
            assert!((value[index] - signal[index]).abs() < 1e-12);
            assert!((slope[index] - (0.1 * t - 0.2)).abs() < 1e-9);
            assert!((bend[index] - 0.1).abs() < 1e-7);
        }
    }
}
