//! A servo model between the command and the spool.

use nalgebra::{Matrix3, Vector3};

/// Interpolation of a command between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Between {
    /// Straight lines.
    Lines,
    /// Held until the next one.
    Held,
}

/// A first-order lag with a delay and a limited rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Servo {
    /// Time constant, s.
    pub lag: f64,
    /// Delay of the command at the servo, s; negative if the command is late in the recording.
    pub delay: f64,
    /// Largest rate of the opening, m²/s; infinite if there is no limit.
    pub rate: f64,
    /// Command between its samples.
    pub between: Between,
}

/// Standard errors by which a gain must differ from 1, an offset from 0 and a start from rest to count as significant. A pump's
/// pressure can depend on the square of a valve's remaining opening: there a hundredth of the sensor's noise exceeds the noise
/// of the pressure sensor.
const DOUBT: f64 = 3.0;

/// Possible responses of a spool behind a servo: it follows the command, and settles from its position at the start of the
/// recording.
pub(super) struct Courses {
    /// The command behind the servo, m²: for a spool that was at its commanded position when the recording began.
    settled: Vec<f64>,
    /// Decaying contribution of another initial position, from 1.
    begin: Vec<f64>,
}

impl Courses {
    /// For `command`, m², at the times `time`, s.
    pub fn new(time: &[f64], command: &[f64], servo: Servo) -> Self {
        let settled = match servo.between {
            _ if servo.rate.is_finite() => behind_limited(time, command, servo),
            Between::Lines => behind_lines(time, command, servo),
            Between::Held => behind_steps(time, command, servo),
        };
        let mut decay = Decay::of(servo.lag);
        let mut begin = Vec::with_capacity(time.len());
        let mut left = 1.0;
        begin.push(left);
        for pair in time.windows(2) {
            left *= decay.over(pair[1] - pair[0]);
            begin.push(left);
        }
        Courses { settled, begin }
    }

    /// The course nearest to `measured`, with free gain, offset and initial position.
    pub fn nearest(&self, measured: &[f64]) -> Option<Vec<f64>> {
        self.nearest_of(measured, [true; 3])
    }

    /// The simplest course that is consistent with the sensor.
    pub fn simplest(&self, measured: &[f64], noise: f64) -> Vec<f64> {
        let any = self.nearest(measured);
        let least = any.as_ref().map_or(f64::INFINITY, |nearest| misfit(measured, nearest));
        let contradicts =
            |course: &Vec<f64>, dropped: f64| misfit(measured, course) - least > dropped * (DOUBT * noise).powi(2);
        // Nothing free, only the initial position free, or only gain and offset free; all free otherwise.
        [([false, false, false], 3.0), ([false, false, true], 2.0), ([true, true, false], 1.0)]
            .into_iter()
            .filter_map(|(free, dropped)| Some((self.nearest_of(measured, free)?, dropped)))
            .find(|(course, dropped)| !contradicts(course, *dropped))
            .map(|(course, _)| course)
            .or(any)
            .unwrap_or_else(|| self.settled.clone())
    }

    /// The course nearest to `measured`; gain, offset and initial position keep their nominal values unless they are `free`.
    fn nearest_of(&self, measured: &[f64], free: [bool; 3]) -> Option<Vec<f64>> {
        let fixed = |settled: f64| if free[0] { 0.0 } else { settled };
        let parts = |settled: f64, begin: f64| {
            // Scaled to the size of the opening, so that no column is lost in rounding.
            Vector3::new(settled, AREA, AREA * begin)
                .zip_map(&Vector3::from(free), |value, free| if free { value } else { 0.0 })
        };
        let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for ((&measured, &settled), &begin) in measured.iter().zip(&self.settled).zip(&self.begin) {
            let part = parts(settled, begin);
            matrix += part * part.transpose();
            right += part * (measured - fixed(settled));
        }
        for number in (0..3).filter(|&number| !free[number]) {
            matrix[(number, number)] = 1.0;
        }
        let scale = matrix.diagonal().map(|value: f64| 1.0 / value.sqrt());
        if !scale.iter().all(|value| value.is_finite()) {
            return None;
        }
        let scaled = Matrix3::from_diagonal(&scale) * matrix * Matrix3::from_diagonal(&scale);
        let weights = scaled.cholesky()?.solve(&right.component_mul(&scale)).component_mul(&scale);
        let course = self.settled.iter().zip(&self.begin);
        Some(course.map(|(&settled, &begin)| fixed(settled) + parts(settled, begin).dot(&weights)).collect())
    }
}

/// An opening of ordinary size, m².
const AREA: f64 = 1e-5;

/// Sum of squared distances.
pub(super) fn misfit(measured: &[f64], follower: &[f64]) -> f64 {
    measured.iter().zip(follower).map(|(measured, follower)| (measured - follower).powi(2)).sum()
}

/// The command at successive times: straight lines between its samples, or held until the next one.
fn course_of<'s>(time: &'s [f64], command: &'s [f64], between: Between) -> impl FnMut(f64) -> f64 + 's {
    let mut position = 0;
    move |at: f64| {
        while position + 2 < time.len() && time[position + 1] < at {
            position += 1;
        }
        let fraction = ((at - time[position]) / (time[position + 1] - time[position])).clamp(0.0, 1.0);
        let fraction = if between == Between::Held { fraction.floor() } else { fraction };
        command[position] + fraction * (command[position + 1] - command[position])
    }
}

/// Parts of a sample interval; in each, a rate-limited servo is either at its limit or not.
const PARTS: usize = 4;

/// The command behind a servo with a limited rate: in each part of an interval it is at its limit, or follows a straight line.
fn behind_limited(time: &[f64], command: &[f64], servo: Servo) -> Vec<f64> {
    let Servo { lag, delay, rate, between } = servo;
    let mut delayed = course_of(time, command, between);
    let mut from = delayed(time[0] - delay);
    let mut state = from;
    let mut decay_of_part = Decay::of(lag);
    let mut spool = vec![state];
    for pair in time.windows(2) {
        let step = (pair[1] - pair[0]) / PARTS as f64;
        let decay = decay_of_part.over(step);
        for part in 1..=PARTS {
            let to = delayed(pair[0] + step * part as f64 - delay);
            let slope = (to - from) / step;
            let free = to - slope * lag + (state - from + slope * lag) * decay;
            state += (free - state).clamp(-rate * step, rate * step);
            from = to;
        }
        spool.push(state);
    }
    spool
}

/// Samples are even except for rounding: an exponential is recomputed if the interval differs by more than this fraction.
const SAME_INTERVAL: f64 = 1e-9;

/// Decay of a deviation over time.
struct Decay {
    lag: f64,
    interval: f64,
    left: f64,
}

impl Decay {
    fn of(lag: f64) -> Self {
        Decay { lag, interval: f64::NAN, left: f64::NAN }
    }

    /// The fraction that remains after `interval`, s.
    fn over(&mut self, interval: f64) -> f64 {
        let same = (interval - self.interval).abs() <= SAME_INTERVAL * self.interval;
        if !same {
            (self.interval, self.left) = (interval, (-interval / self.lag).exp());
        }
        self.left
    }
}

/// The servo's response to linearly interpolated commands, integrated exactly.
fn behind_lines(time: &[f64], command: &[f64], servo: Servo) -> Vec<f64> {
    let Servo { lag, delay, between, .. } = servo;
    let mut delayed = course_of(time, command, between);
    let mut from = delayed(time[0] - delay);
    let mut state = from;
    let mut decay = Decay::of(lag);
    let mut spool = Vec::with_capacity(time.len());
    spool.push(state);
    for pair in time.windows(2) {
        let to = delayed(pair[1] - delay);
        let step = pair[1] - pair[0];
        let slope = (to - from) / step;
        state = to - slope * lag + (state - from + slope * lag) * decay.over(step);
        spool.push(state);
        from = to;
    }
    spool
}

/// The servo's response to held commands, integrated exactly.
fn behind_steps(time: &[f64], command: &[f64], servo: Servo) -> Vec<f64> {
    let Servo { lag, delay, .. } = servo;
    let mut changes = time.iter().map(|t| t + delay).zip(command.iter().copied()).peekable();
    let mut held = command[0];
    while let Some((_, next)) = changes.next_if(|(at, _)| *at <= time[0]) {
        held = next;
    }
    let mut state = held;
    let mut decay = Decay::of(lag);
    let mut spool = Vec::with_capacity(time.len());
    spool.push(state);
    for pair in time.windows(2) {
        let mut now = pair[0];
        while let Some((at, next)) = changes.next_if(|(at, _)| *at <= pair[1]) {
            // Most commands repeat the previous one.
            if next != held {
                state = held + (state - held) * ((now - at) / lag).exp();
                (now, held) = (at, next);
            }
        }
        let left = if now == pair[0] { decay.over(pair[1] - now) } else { ((now - pair[1]) / lag).exp() };
        state = held + (state - held) * left;
        spool.push(state);
    }
    spool
}
