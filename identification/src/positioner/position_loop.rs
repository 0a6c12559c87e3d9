//! The simulation of a position loop.

/// A position loop: valve and cylinder follow the error of the position. It has no pressures.
///
/// ```text
/// lag dz/dt = r(t - delay) - x - offset - z,    dx/dt = gain band(z), at most top_speed
/// ```
///
/// with the reference r, the position x, and `band(z) = z - dead_band` beyond the dead band on each side, else zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionLoop {
    /// Speed over error, 1/s.
    pub gain: f64,
    /// Error that moves nothing, m: the dead zone of the valve and the friction of the piston, as seen by the loop.
    pub dead_band: f64,
    /// Time constant of the valve, s.
    pub lag: f64,
    /// Time by which the reference acts late, s.
    pub delay: f64,
    /// Largest speed, m/s: that of the fully open valve.
    pub top_speed: f64,
    /// Reference less position where the loop rests, m.
    pub offset: f64,
}

/// Longest step of the simulation, s, as a share of the lag: the method is stable up to twice the lag.
const STEP: f64 = 0.25;

/// Shortest lag that is simulated, s: faster than any valve.
pub(super) const SHORTEST_LAG: f64 = 2e-4;

impl PositionLoop {
    /// Number of parameters.
    pub(super) const COUNT: usize = 6;

    pub(super) fn of_values([gain, dead_band, lag, delay, top_speed, offset]: [f64; Self::COUNT]) -> Self {
        PositionLoop { gain, dead_band, lag, delay, top_speed, offset }
    }

    /// Position (m) at these times (s) for a reference (m), from `begin` (m) on.
    pub fn simulate(&self, time: &[f64], reference: &[f64], begin: f64) -> Vec<f64> {
        let lag = self.lag.max(SHORTEST_LAG);
        let late = self.delayed(time, reference);
        let (mut position, mut spool) = (begin, 0.0);
        let mut found = Vec::with_capacity(time.len());
        for index in 0..time.len() {
            found.push(position);
            let Some(next) = time.get(index + 1) else { break };
            let length = (next - time[index]).max(0.0);
            let steps = (length / (STEP * lag)).ceil().clamp(1.0, 1e4);
            let step = length / steps;
            for number in 0..steps as usize {
                let share = (number as f64 + 0.5) / steps;
                let reference = late[index] + (late[index + 1] - late[index]) * share;
                spool += step / lag * (reference - position - self.offset - spool);
                position += step * self.speed(spool);
            }
        }
        found
    }

    fn speed(&self, spool: f64) -> f64 {
        let speed = self.gain * (spool.abs() - self.dead_band).max(0.0) * spool.signum();
        self.top_speed * (speed / self.top_speed).tanh()
    }

    /// The reference `delay` earlier, on straight lines between its samples.
    fn delayed(&self, time: &[f64], reference: &[f64]) -> Vec<f64> {
        let mut at = 0;
        let value = |wanted: f64| {
            while at + 2 < time.len() && time[at + 1] < wanted {
                at += 1;
            }
            let Some(next) = time.get(at + 1) else { return reference[at] };
            let share = ((wanted - time[at]) / (next - time[at])).clamp(0.0, 1.0);
            reference[at] + (reference[at + 1] - reference[at]) * share
        };
        time.iter().map(|moment| moment - self.delay).map(value).collect()
    }

    /// Frequency at which the amplitude of the linear loop has fallen by 3 dB, Hz.
    pub fn bandwidth(&self) -> f64 {
        let gain_at = |hertz: f64| {
            let w = std::f64::consts::TAU * hertz;
            // G = K exp(-j w D) / (j w (1 + j w T)); |G/(1 + G)| = K / |K exp(-j w D) + j w (1 + j w T)|.
            let (real, imaginary) =
                (self.gain * (w * self.delay).cos() - w * w * self.lag, w - self.gain * (w * self.delay).sin());
            self.gain / real.hypot(imaginary)
        };
        let limit = std::f64::consts::FRAC_1_SQRT_2;
        let frequencies = (0..4000).map(|step| 0.01 * 10_f64.powf(f64::from(step) / 1000.0));
        frequencies.take_while(|hertz| gain_at(*hertz) > limit).last().unwrap_or(0.0)
    }
}
