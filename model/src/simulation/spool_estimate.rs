//! The best estimate of where a spool really was.

use super::spool_memory::remembered;
use crate::recording::{denoised, denoised_towards_zero, noise_level, resolution};

/// Spool position (m²) from its sensor and, where there is one, from the command that moved it.
///
/// A spool follows its command through a servo; a lag of first order with a delay, gain and offset, fitted to the
/// recording, explains most of the motion without any noise. What it leaves is denoised and added back where it is beyond
/// doubt, so that nothing the sensor saw beyond its noise is lost: with a perfect servo the result is noiseless, with none
/// it is the denoised measurement. Doubtful values would do harm: a valve with play of a few noise levels ends where its
/// spool came last, and every little wave of the estimate about a resting spool would take it along.
pub(super) fn spool_estimate(time: &[f64], measured: &[f64], command: &[f64]) -> Vec<f64> {
    remembered(time, measured, command, || estimate(time, measured, command))
}

fn estimate(time: &[f64], measured: &[f64], command: &[f64]) -> Vec<f64> {
    if time.len() < 3 || noise_level(measured) == 0.0 || !command.iter().all(|area| area.is_finite()) {
        return denoised(measured);
    }
    let Some(follower) = best_follower(time, measured, command) else { return denoised(measured) };
    let rest: Vec<f64> = measured.iter().zip(&follower).map(|(measured, follower)| measured - follower).collect();
    // A poor servo model would add corners of its own; then the sensor alone is the better witness.
    if noise_level(&rest) > 1.2 * noise_level(measured) {
        return denoised(measured);
    }
    let half_a_step = 0.5 * resolution(measured);
    denoised_towards_zero(&rest, half_a_step).iter().zip(&follower).map(|(rest, follower)| rest + follower).collect()
}

/// Time constants that are tried, s: from faster than any sampling to a slow pilot stage.
const LAGS: [f64; 10] = [0.001, 0.002, 0.004, 0.007, 0.012, 0.02, 0.035, 0.06, 0.1, 0.2];

/// Samples that the servo model is searched on; longer recordings are thinned, two numbers need no more for a start, and
/// are polished on all samples.
const SEARCH_SAMPLES: usize = 2000;

/// The lagged, delayed, scaled and shifted command that is nearest to the measured spool.
fn best_follower(time: &[f64], measured: &[f64], command: &[f64]) -> Option<Vec<f64>> {
    let stride = (time.len() / SEARCH_SAMPLES).max(1);
    let thin = |values: &[f64]| values.iter().copied().step_by(stride).collect::<Vec<f64>>();
    let (mut lag, mut delay) = best_lag_and_delay(&thin(time), &thin(measured), &thin(command))?;
    // What thinning leaves of the error in time shifts the opening of the whole recording, and nothing that comes after
    // could tell: two Newton steps on all samples take it down to what the sensor knows.
    for _ in 0..2 {
        (lag, delay) = polished(time, measured, command, lag, delay)?;
    }
    scaled_to(measured, &lagged(time, command, lag, delay))
}

/// One Gauss-Newton step for lag and delay on all samples, taken only if it improves the fit.
fn polished(time: &[f64], measured: &[f64], command: &[f64], lag: f64, delay: f64) -> Option<(f64, f64)> {
    // Steps over which the follower changes visibly and still in proportion.
    let (lag_change, delay_change) = (0.02 * lag, 2e-4);
    let follower = |lag: f64, delay: f64| scaled_to(measured, &lagged(time, command, lag, delay));
    let (here, by_lag, by_delay) =
        (follower(lag, delay)?, follower(lag + lag_change, delay)?, follower(lag, delay + delay_change)?);
    let (mut matrix, mut right) = (nalgebra::Matrix2::zeros(), nalgebra::Vector2::zeros());
    let mut squares = 0.0;
    for (((measured, here), by_lag), by_delay) in measured.iter().zip(&here).zip(&by_lag).zip(&by_delay) {
        let slope = nalgebra::Vector2::new((by_lag - here) / lag_change, (by_delay - here) / delay_change);
        let rest = measured - here;
        matrix += slope * slope.transpose();
        right += slope * rest;
        squares += rest * rest;
    }
    // Scaled to unit diagonal: areas of 1e-5 m² make the plain determinant vanish in rounding.
    let scale = nalgebra::Vector2::new(1.0 / matrix[(0, 0)].sqrt(), 1.0 / matrix[(1, 1)].sqrt());
    if !scale.iter().all(|value| value.is_finite()) {
        return Some((lag, delay));
    }
    let scaled = nalgebra::Matrix2::from_diagonal(&scale) * matrix * nalgebra::Matrix2::from_diagonal(&scale);
    let Some(step) = scaled.lu().solve(&right.component_mul(&scale)) else { return Some((lag, delay)) };
    let step = step.component_mul(&scale);
    let (better_lag, better_delay) = ((lag + step[0]).max(lag / 2.0), delay + step[1]);
    let after: f64 = measured.iter().zip(follower(better_lag, better_delay)?).map(|(m, f)| (m - f) * (m - f)).sum();
    Some(if after < squares { (better_lag, better_delay) } else { (lag, delay) })
}

fn best_lag_and_delay(time: &[f64], measured: &[f64], command: &[f64]) -> Option<(f64, f64)> {
    let misfit = |lag: f64, delay: f64| {
        let follower = scaled_to(measured, &lagged(time, command, lag, delay))?;
        let squares: f64 = measured.iter().zip(&follower).map(|(m, f)| (m - f) * (m - f)).sum();
        Some(squares)
    };
    let mut best = (f64::INFINITY, 0.0, 0.0);
    let consider = |lag: f64, delay: f64, best: &mut (f64, f64, f64)| {
        if let Some(squares) = misfit(lag, delay)
            && squares < best.0
        {
            *best = (squares, lag, delay);
        }
    };
    for lag in LAGS {
        consider(lag, 0.0, &mut best);
    }
    // Coordinate search from the best of the grid; the misfit is smooth in both.
    let (mut lag_factor, mut delay_step) = (1.3_f64, 0.004);
    for _ in 0..24 {
        let (before, lag, delay) = (best.0, best.1, best.2);
        consider(lag * lag_factor, delay, &mut best);
        consider(lag / lag_factor, delay, &mut best);
        consider(best.1, delay + delay_step, &mut best);
        consider(best.1, delay - delay_step, &mut best);
        if best.0 >= before {
            lag_factor = lag_factor.sqrt();
            delay_step /= 2.0;
        }
    }
    best.0.is_finite().then_some((best.1, best.2))
}

/// The command after a lag of first order and a delay, both in s.
fn lagged(time: &[f64], command: &[f64], lag: f64, delay: f64) -> Vec<f64> {
    let mut position = 0;
    let mut delayed = |at: f64| {
        while position + 2 < time.len() && time[position + 1] < at {
            position += 1;
        }
        let fraction = ((at - time[position]) / (time[position + 1] - time[position])).clamp(0.0, 1.0);
        command[position] + fraction * (command[position + 1] - command[position])
    };
    let mut from = delayed(time[0] - delay);
    let mut state = from;
    let mut result = Vec::with_capacity(time.len());
    result.push(state);
    let mut decay = (f64::NAN, f64::NAN);
    for pair in time.windows(2) {
        // Straight lines between commands, exactly integrated: a held command is the same with half a sample's delay,
        // which the delay takes up.
        let to = delayed(pair[1] - delay);
        let step = pair[1] - pair[0];
        let slope = (to - from) / step;
        // Most clocks tick evenly: one exponential does for many samples.
        if (step - decay.0).abs() > 1e-9 * step || decay.0.is_nan() {
            decay = (step, (-step / lag).exp());
        }
        state = to - slope * lag + (state - from + slope * lag) * decay.1;
        result.push(state);
        from = to;
    }
    result
}

/// `gain follower + offset` nearest to `measured`.
fn scaled_to(measured: &[f64], follower: &[f64]) -> Option<Vec<f64>> {
    let count = measured.len() as f64;
    let (mean, mean_follower) = (measured.iter().sum::<f64>() / count, follower.iter().sum::<f64>() / count);
    let variance: f64 = follower.iter().map(|value| (value - mean_follower).powi(2)).sum();
    if variance.is_nan() || variance <= 0.0 {
        return None;
    }
    let covariance: f64 = measured.iter().zip(follower).map(|(m, f)| (m - mean) * (f - mean_follower)).sum();
    let gain = covariance / variance;
    Some(follower.iter().map(|value| mean + gain * (value - mean_follower)).collect())
}
