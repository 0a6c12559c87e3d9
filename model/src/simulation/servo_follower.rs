//! Identifies the servo between command and spool from a recording.

use nalgebra::{DMatrix, DVector};

use super::servo::{Between, Courses, Servo, misfit};
use crate::recording::median_interval;

/// Candidate time constants, in sample intervals: from faster than any sampling to a slow pilot stage.
const LAGS: [f64; 12] = [0.5, 1.0, 2.0, 3.5, 6.0, 10.0, 17.5, 30.0, 50.0, 100.0, 200.0, 400.0];

/// Samples for the search of the servo. Longer recordings are thinned, which is enough for start values of two numbers; the
/// refinement uses all samples.
const SEARCH_SAMPLES: usize = 2000;

/// Lags below this, in sample intervals, count as zero: they cannot be separated from a delay, and a search for both would not
/// converge.
const SHORTEST_LAG: f64 = 0.25;

/// The lagged, delayed, scaled and shifted command (m²) that is nearest to the measured spool, whose sensor's noise has the
/// standard deviation `noise`, m². `None` if the command never moves.
///
/// Where the sensor is inconclusive, the simplest assumption applies: the spool goes to its commanded position, and was there
/// before the recording began.
pub(super) fn servo_follower(time: &[f64], measured: &[f64], command: &[f64], noise: f64) -> Option<Vec<f64>> {
    let stride = (time.len() / SEARCH_SAMPLES).max(1);
    let thin = |values: &[f64]| values.iter().copied().step_by(stride).collect::<Vec<f64>>();
    // The median: pauses of hours between pieces must not affect the interval.
    let interval = median_interval(time);
    let shortest_lag = SHORTEST_LAG * interval;
    let lines = best_servo(&thin(time), &thin(measured), &thin(command), interval)?;
    // A held command is the interpolated one half an interval later.
    let held = Servo { delay: lines.delay - interval / 2.0, between: Between::Held, ..lines };
    // A command sent as a message jumps at once; a sampled knob moves continuously between samples.
    let (_, servo) = [lines, held]
        .into_iter()
        .filter_map(|servo| polished(time, measured, command, servo, shortest_lag))
        .min_by(|a, b| a.0.total_cmp(&b.0))?;
    let limited = limited(time, measured, command, servo, shortest_lag, noise);
    Some(Courses::new(time, command, limited.unwrap_or(servo)).simplest(measured, noise))
}

/// Candidate rates, as fractions of the fastest rate of the spool behind a servo without a limit.
const RATES: [f64; 6] = [0.9, 0.75, 0.6, 0.45, 0.3, 0.2];

/// Standard deviations of the sensor's noise that a rate limit must explain, over all its readings together.
const DOUBT: f64 = 5.0;

/// The servo with a limited rate, if the sensor shows one. Without the limit, the follower runs ahead on every fast move. The
/// closing of a valve, which decides where the load stops, would then be off by a fraction of the sensor's noise.
fn limited(
    time: &[f64],
    measured: &[f64],
    command: &[f64],
    servo: Servo,
    shortest_lag: f64,
    noise: f64,
) -> Option<Servo> {
    let free = Courses::new(time, command, servo).nearest(measured)?;
    let unlimited = misfit(measured, &free);
    let rate = |(t, u): (&[f64], &[f64])| ((u[1] - u[0]) / (t[1] - t[0])).abs();
    let fastest = time.windows(2).zip(free.windows(2)).map(rate).fold(0.0, f64::max);
    let start = RATES
        .iter()
        .map(|part| Servo { rate: part * fastest, ..servo })
        .filter_map(|limited| {
            Some((misfit(measured, &Courses::new(time, command, limited).nearest(measured)?), limited))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(reached, _)| *reached < unlimited)?;
    let (reached, limited) = polished(time, measured, command, start.1, shortest_lag)?;
    (unlimited - reached > (DOUBT * noise).powi(2)).then_some(limited)
}

/// Gauss-Newton steps on all samples. The time error left by thinning would shift the opening of the whole recording, which no
/// later stage could detect. Three steps reduce it to the accuracy of the sensor.
const STEPS: usize = 3;

/// The same for a limited rate, whose start is a guess: lag and delay have compensated for it as far as they could.
const STEPS_LIMITED: usize = 10;

/// The servo near `servo` that is nearest to the measured spool, and its misfit.
fn polished(time: &[f64], measured: &[f64], command: &[f64], servo: Servo, shortest_lag: f64) -> Option<(f64, Servo)> {
    let nearest = |servo: Servo| Courses::new(time, command, servo).nearest(measured);
    let (mut servo, mut here) = (servo, nearest(servo)?);
    let steps = if servo.rate.is_finite() { STEPS_LIMITED } else { STEPS };
    for _ in 0..steps {
        // Steps that change the course visibly but still linearly.
        let (lag_change, delay_change, rate_change) = (0.02 * servo.lag, 0.4 * shortest_lag, 0.02 * servo.rate);
        let mut slopes = vec![
            slope(&here, &nearest(Servo { lag: servo.lag + lag_change, ..servo })?, lag_change),
            slope(&here, &nearest(Servo { delay: servo.delay + delay_change, ..servo })?, delay_change),
        ];
        if servo.rate.is_finite() {
            slopes.push(slope(&here, &nearest(Servo { rate: servo.rate + rate_change, ..servo })?, rate_change));
        }
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let rest: Vec<f64> = measured.iter().zip(&here).map(|(measured, here)| measured - here).collect();
        let right = DVector::from_iterator(slopes.len(), slopes.iter().map(|slope| product(slope, &rest)));
        let matrix = DMatrix::from_fn(slopes.len(), slopes.len(), |row, column| product(&slopes[row], &slopes[column]));
        // Scaled to unit diagonal: areas of 1e-5 m² make the plain determinant vanish in rounding.
        let scale = matrix.diagonal().map(|value: f64| 1.0 / value.sqrt());
        if !scale.iter().all(|value| value.is_finite()) {
            break;
        }
        let scaled = DMatrix::from_diagonal(&scale) * &matrix * DMatrix::from_diagonal(&scale);
        let all = scaled.lu().solve(&right.component_mul(&scale)).map(|step| step.component_mul(&scale));
        // If a lag and a delay cannot be separated, only the delay is used.
        let mut delay_alone = DVector::zeros(slopes.len());
        delay_alone[1] = right[1] / matrix[(1, 1)];
        let shorter = |step: &DVector<f64>| [1.0, 0.5, 0.25].map(|part| step * part);
        let tried = all.iter().flat_map(shorter).chain([delay_alone]);
        let better = tried.into_iter().find_map(|step| {
            let lag = (servo.lag + step[0]).max(servo.lag / 2.0).max(shortest_lag);
            let rate = step.get(2).map_or(servo.rate, |step| (servo.rate + step).max(servo.rate / 2.0));
            let better = Servo { lag, delay: servo.delay + step[1], rate, ..servo };
            let there = nearest(better)?;
            (misfit(measured, &there) < misfit(measured, &here)).then_some((better, there))
        });
        let Some(better) = better else { break };
        (servo, here) = better;
    }
    Some((misfit(measured, &here), servo))
}

/// Change of a course per unit of a parameter changed by `change`.
fn slope(here: &[f64], there: &[f64], change: f64) -> Vec<f64> {
    here.iter().zip(there).map(|(here, there)| (there - here) / change).collect()
}

fn best_servo(time: &[f64], measured: &[f64], command: &[f64], interval: f64) -> Option<Servo> {
    let mut best = (f64::INFINITY, 0.0, 0.0);
    let consider = |lag: f64, delay: f64, best: &mut (f64, f64, f64)| {
        let lag = lag.max(SHORTEST_LAG * interval);
        let servo = Servo { lag, delay, rate: f64::INFINITY, between: Between::Lines };
        let Some(nearest) = Courses::new(time, command, servo).nearest(measured) else { return };
        let squares = misfit(measured, &nearest);
        if squares < best.0 {
            *best = (squares, lag, delay);
        }
    };
    for lag in LAGS {
        consider(lag * interval, 0.0, &mut best);
    }
    // Coordinate search from the best grid point; the misfit is smooth in both variables.
    let (mut lag_factor, mut delay_step) = (1.3_f64, 2.0 * interval);
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
    best.0.is_finite().then_some(Servo { lag: best.1, delay: best.2, rate: f64::INFINITY, between: Between::Lines })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};

    use super::*;

    /// Noise of a good spool sensor, m².
    const NOISE: f64 = 2e-7;

    /// A minute of a spool that starts `away` m² from its commanded position, behind a servo of 12 ms: times, command, true
    /// position.
    fn steered(away: f64) -> [Vec<f64>; 3] {
        let time: Vec<f64> = (0..30_000).map(|k| 0.002 * f64::from(k)).collect();
        let command: Vec<f64> =
            time.iter().map(|t| 7e-5 * (1.3 * t).sin() + if t.rem_euclid(5.0) < 1.0 { 4e-5 } else { 0.0 }).collect();
        let mut spool = vec![command[0] + away];
        for pair in command.windows(2) {
            let last = spool[spool.len() - 1];
            spool.push(pair[0] + (last - pair[0]) * (-0.002_f64 / 0.012).exp());
        }
        [time, command, spool]
    }

    fn read(spool: &[f64], gain: f64, offset: f64) -> Vec<f64> {
        let noise = Normal::new(0.0, NOISE).unwrap();
        let mut random = ChaCha8Rng::seed_from_u64(7);
        spool.iter().map(|area| gain * area + offset + noise.sample(&mut random)).collect()
    }

    fn largest_error(follower: &[f64], truth: impl Iterator<Item = f64>) -> f64 {
        follower.iter().zip(truth).map(|(follower, truth)| (follower - truth).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_sensor_that_reads_what_was_told_has_neither_gain_nor_offset() {
        let [time, command, spool] = steered(0.0);
        let follower = servo_follower(&time, &read(&spool, 1.0, 0.0), &command, NOISE).unwrap();
        // At rest it equals the command, except for the part that has not settled yet.
        let resting = (0..time.len()).filter(|&k| (4.9..5.0).contains(&time[k].rem_euclid(5.0)));
        let off = |k: usize| (follower[k] - spool[k]).abs();
        assert!(resting.map(off).fold(0.0, f64::max) < 1e-9);
        assert!(largest_error(&follower, spool.iter().copied()) < NOISE / 2.0);
    }

    #[test]
    fn a_sensor_with_gain_and_offset_is_believed() {
        let [time, command, spool] = steered(0.0);
        let follower = servo_follower(&time, &read(&spool, 1.01, 3e-7), &command, NOISE).unwrap();
        assert!(largest_error(&follower, spool.iter().map(|area| 1.01 * area + 3e-7)) < NOISE / 2.0);
    }

    #[test]
    fn a_recording_may_begin_while_the_spool_moves() {
        let [time, command, spool] = steered(-9e-5);
        let follower = servo_follower(&time, &read(&spool, 1.0, 0.0), &command, NOISE).unwrap();
        // A dozen readings determine its start.
        assert!(largest_error(&follower, spool.iter().copied()) < NOISE);
        assert!(largest_error(&follower[100..], spool[100..].iter().copied()) < NOISE / 10.0);
    }

    #[test]
    fn without_a_servo_the_delay_is_found_to_a_fortieth_of_a_sample() {
        let time: Vec<f64> = (0..7500).map(|k| 0.002 * f64::from(k)).collect();
        let edge = |t: f64, at: f64| 0.5 * (1.0 + ((t.rem_euclid(5.0) - at) / 2e-2).tanh());
        let area = |t: f64| 6e-5 * (edge(t, 1.0) - edge(t, 1.5) - edge(t, 2.2) + edge(t, 2.7));
        let command: Vec<f64> = time.iter().map(|&t| area(t)).collect();
        for lead in [4e-4, -3e-4] {
            let spool: Vec<f64> = time.iter().map(|&t| area(t + lead)).collect();
            let follower = servo_follower(&time, &read(&spool, 1.0, 0.0), &command, NOISE).unwrap();
            // The steepest edge has 1.5e-3 m²/s.
            let error = largest_error(&follower, spool.iter().copied());
            assert!(error < 5e-5 * 1.5e-3, "{error:e}");
        }
    }

    #[test]
    fn a_limited_rate_is_found() {
        let [time, command, _] = steered(0.0);
        let (lag, rate) = (0.012, 1.1e-3);
        let mut spool = vec![command[0]];
        for pair in command.windows(2) {
            // In steps of a tenth of a millisecond, along the line from one command to the next.
            let last = spool[spool.len() - 1];
            spool.push((0..20).fold(last, |now, part| {
                let told = pair[0] + (pair[1] - pair[0]) * (f64::from(part) + 0.5) / 20.0;
                now + 1e-4 * ((told - now) / lag).clamp(-rate, rate)
            }));
        }
        let follower = servo_follower(&time, &read(&spool, 1.0, 0.0), &command, NOISE).unwrap();
        // Without the limit it would run ahead by 1e-5 m² on the way.
        let error = largest_error(&follower, spool.iter().copied());
        assert!(error < NOISE / 2.0, "{error:e}");
        let resting = (0..time.len()).filter(|&k| (4.9..5.0).contains(&time[k].rem_euclid(5.0)));
        let off = |k: usize| (follower[k] - spool[k]).abs();
        assert!(resting.map(off).fold(0.0, f64::max) < 5e-9);
    }

    #[test]
    fn a_command_that_never_moves_has_no_follower() {
        let [time, _, spool] = steered(0.0);
        assert!(servo_follower(&time, &spool, &vec![0.0; time.len()], NOISE).is_none());
    }
}
