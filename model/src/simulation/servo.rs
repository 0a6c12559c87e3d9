//! A servo that a spool follows its command through, found in a recording.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// Time constants that are tried, s: from faster than any sampling to a slow pilot stage.
const LAGS: [f64; 10] = [0.001, 0.002, 0.004, 0.007, 0.012, 0.02, 0.035, 0.06, 0.1, 0.2];

/// Samples that the servo is searched on; longer recordings are thinned, two numbers need no more for a start, and
/// are polished on all samples.
const SEARCH_SAMPLES: usize = 2000;

/// Standard errors by which a gain must differ from 1, an offset from 0 and a start from rest to be taken for more than noise. A
/// pump's pressure can go with the square of what a valve has left to close: a hundredth of the sensor's noise there is
/// more than the noise of the pressure sensor.
const DOUBT: f64 = 3.0;

/// The lagged, delayed, scaled and shifted command (m²) that is nearest to the measured spool, whose sensor's noise has
/// the standard deviation `noise`, m². `None` where the command never moves.
///
/// What the sensor leaves in doubt is as simple as can be: the spool goes where it is told, and it was there before the
/// recording began.
pub(super) fn servo_follower(time: &[f64], measured: &[f64], command: &[f64], noise: f64) -> Option<Vec<f64>> {
    let stride = (time.len() / SEARCH_SAMPLES).max(1);
    let thin = |values: &[f64]| values.iter().copied().step_by(stride).collect::<Vec<f64>>();
    let (mut lag, mut delay) = best_lag_and_delay(&thin(time), &thin(measured), &thin(command))?;
    // What thinning leaves of the error in time shifts the opening of the whole recording, and nothing that comes after
    // could tell: two Newton steps on all samples take it down to what the sensor knows.
    for _ in 0..2 {
        (lag, delay) = polished(time, measured, command, lag, delay)?;
    }
    Some(Courses::new(time, command, lag, delay).simplest(measured, noise))
}

/// One Gauss-Newton step for lag and delay on all samples, taken only if it improves the fit.
fn polished(time: &[f64], measured: &[f64], command: &[f64], lag: f64, delay: f64) -> Option<(f64, f64)> {
    // Steps over which the follower changes visibly and still in proportion.
    let (lag_change, delay_change) = (0.02 * lag, 2e-4);
    let follower = |lag: f64, delay: f64| Courses::new(time, command, lag, delay).nearest(measured);
    let (here, by_lag, by_delay) =
        (follower(lag, delay)?, follower(lag + lag_change, delay)?, follower(lag, delay + delay_change)?);
    let (mut matrix, mut right) = (Matrix2::zeros(), Vector2::zeros());
    for (((measured, here), by_lag), by_delay) in measured.iter().zip(&here).zip(&by_lag).zip(&by_delay) {
        let slope = Vector2::new((by_lag - here) / lag_change, (by_delay - here) / delay_change);
        matrix += slope * slope.transpose();
        right += slope * (measured - here);
    }
    // Scaled to unit diagonal: areas of 1e-5 m² make the plain determinant vanish in rounding.
    let scale = Vector2::new(1.0 / matrix[(0, 0)].sqrt(), 1.0 / matrix[(1, 1)].sqrt());
    if !scale.iter().all(|value| value.is_finite()) {
        return Some((lag, delay));
    }
    let scaled = Matrix2::from_diagonal(&scale) * matrix * Matrix2::from_diagonal(&scale);
    let Some(step) = scaled.lu().solve(&right.component_mul(&scale)) else { return Some((lag, delay)) };
    let step = step.component_mul(&scale);
    let (better_lag, better_delay) = ((lag + step[0]).max(lag / 2.0), delay + step[1]);
    let after = misfit(measured, &follower(better_lag, better_delay)?);
    Some(if after < misfit(measured, &here) { (better_lag, better_delay) } else { (lag, delay) })
}

fn best_lag_and_delay(time: &[f64], measured: &[f64], command: &[f64]) -> Option<(f64, f64)> {
    let mut best = (f64::INFINITY, 0.0, 0.0);
    let consider = |lag: f64, delay: f64, best: &mut (f64, f64, f64)| {
        let Some(nearest) = Courses::new(time, command, lag, delay).nearest(measured) else { return };
        let squares = misfit(measured, &nearest);
        if squares < best.0 {
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

fn misfit(measured: &[f64], follower: &[f64]) -> f64 {
    measured.iter().zip(follower).map(|(measured, follower)| (measured - follower).powi(2)).sum()
}

/// What a spool behind a servo of one lag and delay can do: follow, and settle from where it was when the recording began.
struct Courses {
    /// The command behind the servo, m²: a spool that was where it had been told when the recording began.
    settled: Vec<f64>,
    /// How much of another begin is left, from 1.
    begin: Vec<f64>,
}

impl Courses {
    /// Lag and delay in s.
    fn new(time: &[f64], command: &[f64], lag: f64, delay: f64) -> Self {
        let mut position = 0;
        let mut delayed = |at: f64| {
            while position + 2 < time.len() && time[position + 1] < at {
                position += 1;
            }
            let fraction = ((at - time[position]) / (time[position + 1] - time[position])).clamp(0.0, 1.0);
            command[position] + fraction * (command[position + 1] - command[position])
        };
        let mut from = delayed(time[0] - delay);
        let (mut state, mut rest) = (from, 1.0);
        let (mut settled, mut begin) = (Vec::with_capacity(time.len()), Vec::with_capacity(time.len()));
        settled.push(state);
        begin.push(rest);
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
            rest *= decay.1;
            settled.push(state);
            begin.push(rest);
            from = to;
        }
        Courses { settled, begin }
    }

    /// The course nearest to `measured`, with any gain, offset and begin.
    fn nearest(&self, measured: &[f64]) -> Option<Vec<f64>> {
        self.nearest_of(measured, [true; 3])
    }

    /// The simplest course that the sensor does not contradict.
    fn simplest(&self, measured: &[f64], noise: f64) -> Vec<f64> {
        let any = self.nearest(measured);
        let least = any.as_ref().map_or(f64::INFINITY, |nearest| misfit(measured, nearest));
        let contradicts = |course: &Vec<f64>, dropped: f64| {
            misfit(measured, course) - least > dropped * (DOUBT * noise).powi(2)
        };
        // Nothing free but the begin, nothing free but gain and offset, or all.
        [([false, false, false], 3.0), ([false, false, true], 2.0), ([true, true, false], 1.0)]
            .into_iter()
            .filter_map(|(free, dropped)| Some((self.nearest_of(measured, free)?, dropped)))
            .find(|(course, dropped)| !contradicts(course, *dropped))
            .map(|(course, _)| course)
            .or(any)
            .unwrap_or_else(|| self.settled.clone())
    }

    /// The course nearest to `measured` with the gain, the offset, the begin as they are to be unless they are `free`.
    fn nearest_of(&self, measured: &[f64], free: [bool; 3]) -> Option<Vec<f64>> {
        let fixed = |settled: f64| if free[0] { 0.0 } else { settled };
        let parts = |settled: f64, begin: f64| {
            // Of the size of the opening, so that no column is lost in rounding.
            Vector3::new(settled, AREA, AREA * begin).zip_map(&Vector3::from(free), |value, free| if free { value } else { 0.0 })
        };
        let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for ((&measured, &settled), &begin) in measured.iter().zip(&self.settled).zip(&self.begin) {
            let part = parts(settled, begin);
            matrix += part * part.transpose();
            right += part * (measured - fixed(settled));
        }
        for number in 0..3 {
            if !free[number] {
                matrix[(number, number)] = 1.0;
            } else if !(matrix[(number, number)] > 0.0) {
                return None;
            }
        }
        let scale = matrix.diagonal().map(|value: f64| 1.0 / value.sqrt());
        let scaled = Matrix3::from_diagonal(&scale) * matrix * Matrix3::from_diagonal(&scale);
        let weights = scaled.cholesky()?.solve(&right.component_mul(&scale)).component_mul(&scale);
        let course = self.settled.iter().zip(&self.begin);
        Some(course.map(|(&settled, &begin)| fixed(settled) + parts(settled, begin).dot(&weights)).collect())
    }
}

/// An opening of ordinary size, m².
const AREA: f64 = 1e-5;
