//! Output-error fit of a position loop.

use nalgebra::{SMatrix, SVector};
use serde::Serialize;

use super::position_loop::{PositionLoop, SHORTEST_LAG};
use crate::characterisation::Estimate;

/// Reference and position of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionRecording {
    /// Name.
    pub source: String,
    /// Sample times, s.
    pub time: Vec<f64>,
    /// Reference, m.
    pub reference: Vec<f64>,
    /// Measured position, m.
    pub position: Vec<f64>,
}

/// A fitted position loop, and how well it predicts recordings.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PositionerFit {
    /// Speed over error, 1/s.
    pub gain: Estimate,
    /// Error that moves nothing, m.
    pub dead_band: Estimate,
    /// Time constant of the valve, s.
    pub lag: Estimate,
    /// Time by which the reference acts late, s.
    pub delay: Estimate,
    /// Frequency at which the amplitude has fallen by 3 dB, Hz.
    pub bandwidth: f64,
    /// Time by which the position follows the reference late, s: where both are most alike.
    pub follows_after: f64,
    /// Root mean square error of the position on each recording that was not fitted, m.
    pub errors: Vec<f64>,
    /// The same as shares of the amplitude of the reference.
    pub relative_errors: Vec<f64>,
}

/// Why there is no position loop.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PositionerError {
    /// Too little to fit.
    #[error("{source_name} has {samples} samples of reference and position; {needed} are needed")]
    TooShort {
        /// The recording.
        source_name: String,
        /// Usable samples.
        samples: usize,
        /// Samples that are needed.
        needed: usize,
    },
    /// The position does not follow.
    #[error("the position of {source_name} does not follow its reference: the fit leaves {left:.0} % of its amplitude")]
    NoLoop {
        /// The recording.
        source_name: String,
        /// Root mean square error over the amplitude of the reference, %.
        left: f64,
    },
}

const COUNT: usize = PositionLoop::COUNT;
type Values = SVector<f64, COUNT>;

/// Samples that are needed.
const LEAST_SAMPLES: usize = 200;
/// Iterations of the fit.
const ITERATIONS: usize = 60;
/// Share of the amplitude above which the position does not follow.
const FOLLOWS: f64 = 0.5;
/// Starts of the gain, 1/s, from a slow crane to a fast test actuator.
const GAINS: [f64; 4] = [3.0, 10.0, 30.0, 100.0];
/// Length of the blocks whose residuals count as independent, s: longer than the loop remembers.
const BLOCK: f64 = 0.5;
/// Share of a recording after which the error is counted: what the loop had in memory at the first sample is unknown.
const SETTLED: f64 = 0.02;

/// Fits a position loop to `fitted`, and predicts `judging` with it.
///
/// # Errors
/// [`PositionerError`].
pub fn fit_positioner(
    fitted: &[PositionRecording],
    judging: &[PositionRecording],
) -> Result<PositionerFit, PositionerError> {
    for recording in fitted.iter().chain(judging) {
        if recording.time.len() < LEAST_SAMPLES {
            let (source_name, samples) = (recording.source.clone(), recording.time.len());
            return Err(PositionerError::TooShort { source_name, samples, needed: LEAST_SAMPLES });
        }
    }
    let scales = Scales::of(fitted);
    let fits = GAINS.map(|gain| descend(fitted, scales.start(gain), &scales));
    let best = fits.into_iter().min_by(|one, other| one.1.total_cmp(&other.1));
    let (values, loss) = best.unwrap_or((scales.start(GAINS[0]), f64::INFINITY));
    let samples: usize = fitted.iter().map(|recording| recording.time.len()).sum();
    let left = (loss / samples as f64).sqrt() / scales.amplitude;
    if !left.is_finite() || left > FOLLOWS {
        return Err(PositionerError::NoLoop { source_name: fitted[0].source.clone(), left: 100.0 * left });
    }
    let found = scales.of_values(&values);
    let errors = standard_errors(fitted, &values, &scales);
    let estimate = |index: usize| Estimate { value: values[index] * scales.units[index], error: errors[index] };
    let predicted: Vec<(f64, f64)> = judging.iter().map(|one| error_of(&found, one)).collect();
    Ok(PositionerFit {
        gain: estimate(0),
        dead_band: estimate(1),
        lag: estimate(2),
        delay: estimate(3),
        bandwidth: found.bandwidth(),
        follows_after: follows_after(fitted),
        errors: predicted.iter().map(|(error, _)| *error).collect(),
        relative_errors: predicted.iter().map(|(error, amplitude)| error / amplitude).collect(),
    })
}

/// Units in which all parameters are of order one, and their limits in these units.
struct Scales {
    amplitude: f64,
    units: [f64; COUNT],
    least: Values,
    most: Values,
}

impl Scales {
    fn of(recordings: &[PositionRecording]) -> Self {
        let amplitude = recordings.iter().map(|one| amplitude(&one.reference)).fold(f64::MIN_POSITIVE, f64::max);
        Scales {
            amplitude,
            units: [10.0, 0.01 * amplitude, 0.01, 0.01, 10.0 * amplitude, 0.01 * amplitude],
            least: Values::from([0.01, 0.0, SHORTEST_LAG / 0.01, 0.0, 0.01, -50.0]),
            most: Values::from([100.0, 50.0, 100.0, 50.0, 1000.0, 50.0]),
        }
    }

    fn start(&self, gain: f64) -> Values {
        Values::from([gain / self.units[0], 0.1, 0.5, 0.1, 10.0, 0.0])
    }

    fn of_values(&self, values: &Values) -> PositionLoop {
        PositionLoop::of_values(std::array::from_fn(|index| values[index] * self.units[index]))
    }
}

/// Half of the range of a signal.
fn amplitude(values: &[f64]) -> f64 {
    let (least, most) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &one| (least.min(one), most.max(one)));
    0.5 * (most - least)
}

fn first_position(recording: &PositionRecording) -> f64 {
    let first = &recording.position[..5.min(recording.position.len())];
    first.iter().sum::<f64>() / first.len() as f64
}

/// Simulated less measured position; zero where the loop has not settled.
fn residuals(found: &PositionLoop, recording: &PositionRecording) -> Vec<f64> {
    let simulated = found.simulate(&recording.time, &recording.reference, first_position(recording));
    let from = (SETTLED * recording.time.len() as f64) as usize;
    let pairs = simulated.iter().zip(&recording.position).enumerate();
    pairs.map(|(index, (own, measured))| if index < from { 0.0 } else { own - measured }).collect()
}

fn error_of(found: &PositionLoop, recording: &PositionRecording) -> (f64, f64) {
    let all = residuals(found, recording);
    let mean = all.iter().map(|one| one * one).sum::<f64>() / all.len() as f64;
    (mean.sqrt(), amplitude(&recording.reference))
}

fn all_residuals(recordings: &[PositionRecording], values: &Values, scales: &Scales) -> Vec<f64> {
    let found = scales.of_values(values);
    recordings.iter().flat_map(|recording| residuals(&found, recording)).collect()
}

/// Residuals and their derivatives, by differences.
fn linearised(recordings: &[PositionRecording], values: &Values, scales: &Scales) -> (Vec<f64>, Vec<Values>) {
    const STEP: f64 = 1e-4;
    let now = all_residuals(recordings, values, scales);
    let mut slopes = vec![Values::zeros(); now.len()];
    for index in 0..COUNT {
        let mut moved = *values;
        let step = if values[index] + STEP > scales.most[index] { -STEP } else { STEP };
        moved[index] += step;
        for (slope, (then, now)) in slopes.iter_mut().zip(all_residuals(recordings, &moved, scales).iter().zip(&now)) {
            slope[index] = (then - now) / step;
        }
    }
    (now, slopes)
}

/// Levenberg-Marquardt within the limits; the values and the sum of squares.
fn descend(recordings: &[PositionRecording], start: Values, scales: &Scales) -> (Values, f64) {
    let squares = |residuals: &[f64]| residuals.iter().map(|one| one * one).sum::<f64>();
    let (mut values, mut damping) = (start, 1e-3);
    let mut loss = squares(&all_residuals(recordings, &values, scales));
    for _ in 0..ITERATIONS {
        let (residuals, slopes) = linearised(recordings, &values, scales);
        let information: SMatrix<f64, COUNT, COUNT> = slopes.iter().map(|slope| slope * slope.transpose()).sum();
        let gradient: Values = slopes.iter().zip(&residuals).map(|(slope, one)| slope * *one).sum();
        let before = loss;
        for _ in 0..8 {
            let mut damped = information;
            (0..COUNT).for_each(|index| damped[(index, index)] += damping * (information[(index, index)] + 1e-12));
            let Some(inverse) = damped.try_inverse() else { break };
            let step = inverse * gradient;
            let next = (values - step).zip_zip_map(&scales.least, &scales.most, f64::clamp);
            let then = squares(&all_residuals(recordings, &next, scales));
            if then < loss {
                (values, loss) = (next, then);
                damping = (0.3 * damping).max(1e-9);
                break;
            }
            damping *= 5.0;
        }
        if before - loss < 1e-7 * before {
            break;
        }
    }
    (values, loss)
}

/// Standard errors, with residuals of half a second taken as one.
fn standard_errors(recordings: &[PositionRecording], values: &Values, scales: &Scales) -> [f64; COUNT] {
    let (residuals, slopes) = linearised(recordings, values, scales);
    let interval = (recordings[0].time[1] - recordings[0].time[0]).max(f64::MIN_POSITIVE);
    let block = ((BLOCK / interval).round() as usize).clamp(1, residuals.len());
    let information: SMatrix<f64, COUNT, COUNT> = slopes.iter().map(|slope| slope * slope.transpose()).sum();
    let scores = slopes
        .chunks(block)
        .zip(residuals.chunks(block))
        .map(|(slopes, residuals)| slopes.iter().zip(residuals).map(|(slope, one)| slope * *one).sum::<Values>());
    let spread: SMatrix<f64, COUNT, COUNT> = scores.map(|score| score * score.transpose()).sum();
    let inverse = information.try_inverse().unwrap_or_else(|| SMatrix::repeat(f64::NAN));
    let covariance = inverse * spread * inverse;
    // NaN where the recordings do not tell one parameter from another.
    std::array::from_fn(|index| scales.units[index] * covariance[(index, index)].sqrt())
}

/// Shift of the reference by which it resembles the position most, s.
fn follows_after(recordings: &[PositionRecording]) -> f64 {
    let Some(recording) = recordings.first() else { return f64::NAN };
    let interval = recording.time[1] - recording.time[0];
    let most = ((1.0 / interval) as usize).min(recording.time.len() / 2);
    let distance = |shift: usize| {
        let pairs = recording.reference.iter().zip(&recording.position[shift..]);
        let count = (recording.position.len() - shift) as f64;
        pairs.map(|(reference, position)| (position - reference).powi(2)).sum::<f64>() / count
    };
    let best = (0..most).min_by(|&one, &other| distance(one).total_cmp(&distance(other)));
    best.unwrap_or(0) as f64 * interval
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn recorded(truth: &PositionLoop, frequencies: [f64; 3]) -> PositionRecording {
        let time: Vec<f64> = (0..8000).map(|sample| f64::from(sample) * 2e-3).collect();
        let sum = |t: f64| frequencies.iter().map(|f| 0.01 * (std::f64::consts::TAU * f * t).sin()).sum::<f64>();
        let reference: Vec<f64> = time.iter().map(|&t| sum(t)).collect();
        let exact = truth.simulate(&time, &reference, 0.0);
        let noise = |index: usize| 1e-5 * (2.3 * index as f64).sin();
        let position = exact.iter().enumerate().map(|(index, one)| one + noise(index)).collect();
        PositionRecording { source: "test".into(), time, reference, position }
    }

    #[test]
    fn a_loop_is_found_and_predicts_another_reference() {
        let truth = PositionLoop { gain: 20.0, dead_band: 2e-4, lag: 0.008, delay: 0.004, top_speed: 0.8, offset: 0.0 };
        let (first, other) = (recorded(&truth, [0.5, 1.3, 4.0]), recorded(&truth, [0.7, 2.0, 3.1]));
        let found = fit_positioner(&[first], &[other]).unwrap();
        assert!((found.gain.value / 20.0 - 1.0).abs() < 0.02, "{found:?}");
        assert!((found.dead_band.value - 2e-4).abs() < 4e-5, "{found:?}");
        // Lag and delay look alike at these frequencies; their sum does not.
        assert!((found.lag.value + found.delay.value - 0.012).abs() < 1e-3, "{found:?}");
        assert!(found.relative_errors[0] < 0.002, "{found:?}");
        assert!(found.bandwidth > 3.0 && found.bandwidth < 10.0, "{found:?}");
    }

    #[test]
    fn what_does_not_follow_is_no_loop() {
        let time: Vec<f64> = (0..1000).map(|sample| f64::from(sample) * 2e-3).collect();
        let reference: Vec<f64> = time.iter().map(|t| t.sin()).collect();
        let position: Vec<f64> = time.iter().map(|t| (91.0 * t).cos()).collect();
        let recording = PositionRecording { source: "test".into(), time, reference, position };
        let refused = fit_positioner(std::slice::from_ref(&recording), &[]).unwrap_err();
        assert!(matches!(refused, PositionerError::NoLoop { .. }), "{refused}");
        let short =
            PositionRecording { time: vec![0.0; 3], reference: vec![0.0; 3], position: vec![0.0; 3], ..recording };
        assert!(matches!(fit_positioner(&[short], &[]).unwrap_err(), PositionerError::TooShort { .. }));
    }
}
