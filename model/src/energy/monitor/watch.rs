//! Judging the balances: does the model explain the energy, and could it at all?

use std::collections::VecDeque;

use super::Balance;

/// How the watch judges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WatchSettings {
    /// Time over which powers are averaged, s. 1 s: long against the noise of a differentiated energy, short against
    /// a work cycle.
    pub window: f64,
    /// Standard errors that a mean residual must exceed. 5: with one window per second a false alarm comes once in
    /// twenty days of white noise.
    pub significance: f64,
}

impl Default for WatchSettings {
    fn default() -> Self {
        WatchSettings { window: 1.0, significance: 5.0 }
    }
}

/// The sum of all cylinders over one window.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Window {
    /// End of the window, ns.
    pub nanoseconds: i64,
    /// Length, s.
    pub length: f64,
    /// Energy gained, J.
    pub stored: f64,
    /// Energy supplied, J.
    pub supplied: f64,
    /// Energy that the effects of the model gave, J; negative = dissipated.
    pub dissipated: f64,
    /// Standard error of `stored - supplied - dissipated` from the noise of the signals and from what happens between two
    /// states, J.
    pub standard_error: f64,
    /// Significance asked for.
    pub significance: f64,
    /// Size of `stored - supplied - dissipated` that is below what the balance resolves, J.
    pub resolution: f64,
}

/// Share of the energy that went through, of which a balance says nothing: what happens between two states, above all when
/// a valve steps. Simulator and monitor of the same model leave up to 0.3 % at 1 kHz; sensors are worse.
const SHARE: f64 = 5e-3;
/// Share of the stored energy below which its change is not resolved: what an integration with a relative tolerance of 1e-6
/// leaves, a hundred times less than the best pressure transducers.
const ROUNDING: f64 = 1e-6;

impl Window {
    /// Mean power that the model does not explain, W.
    pub fn residual(&self) -> f64 {
        (self.stored - self.supplied - self.dissipated) / self.length
    }

    /// Size of a mean residual that noise alone does not reach, and at least what the balance resolves, W.
    ///
    /// Noise is carried through the balance as through a linear one. Where the pressure drop over a valve is smaller
    /// than the noise of the pressure sensors the square root is far from linear, the supplied power is biased, and the
    /// residual may exceed this without any physics missing.
    pub fn threshold(&self) -> f64 {
        self.least() / self.length
    }

    /// Energy that neither noise nor resolution explains, J.
    fn least(&self) -> f64 {
        (self.significance * self.standard_error).max(self.resolution)
    }

    /// Whether noise explains what the model does not.
    pub fn is_explained(&self) -> bool {
        self.residual().abs() <= self.threshold()
    }

    /// Whether more energy was stored than supplied, beyond the noise: no passive machine does that, so an instrument
    /// or the supply side of the model is wrong.
    pub fn violates_passivity(&self) -> bool {
        self.stored - self.supplied > self.least()
    }
}

/// Collects balances and judges them window by window.
#[derive(Debug)]
pub struct Watch {
    settings: WatchSettings,
    points: VecDeque<Point>,
}

#[derive(Debug, Clone, Copy)]
struct Point {
    nanoseconds: i64,
    stored: f64,
    /// Sum of the sizes of the stored energies.
    size: f64,
    supply: f64,
    dissipation: f64,
}

/// Fewest balances that a window is judged by.
const FEWEST: usize = 20;
/// Time without a balance that ends a window unjudged, ns.
const GAP: i64 = 200_000_000;

impl Watch {
    /// Judges from now on.
    pub fn new(settings: WatchSettings) -> Self {
        Watch { settings, points: VecDeque::new() }
    }

    /// Takes a balance; gives a window when one is full. Incomplete balances are left out.
    pub fn push(&mut self, balance: &Balance) -> Option<Window> {
        let sum = |of: fn(&super::CylinderBalance) -> f64| balance.cylinders.iter().map(of).sum::<f64>();
        let point = Point {
            nanoseconds: balance.nanoseconds,
            stored: sum(super::CylinderBalance::hamiltonian),
            size: sum(|own| own.kinetic.abs() + own.potential.abs() + own.cap_internal.abs() + own.rod_internal.abs()),
            supply: sum(|cylinder| cylinder.supply),
            dissipation: sum(super::CylinderBalance::dissipation),
        };
        if !(point.stored + point.supply + point.dissipation).is_finite() {
            return None;
        }
        let step = self.points.back().map_or(1, |last| point.nanoseconds.saturating_sub(last.nanoseconds));
        if !(1..=GAP).contains(&step) {
            self.points.clear();
        }
        self.points.push_back(point);
        let first = self.points.front()?.nanoseconds;
        let length = point.nanoseconds.saturating_sub(first) as f64 * 1e-9;
        if length < self.settings.window {
            return None;
        }
        let window = (self.points.len() >= FEWEST).then(|| self.judge(length)).flatten();
        self.points.clear();
        self.points.push_back(point);
        window
    }

    fn judge(&self, length: f64) -> Option<Window> {
        let (first, last) = (self.points.front()?, self.points.back()?);
        let (mut supplied, mut dissipated, mut through, mut between) = (0.0, 0.0, 0.0, 0.0);
        for (left, right) in self.points.iter().zip(self.points.iter().skip(1)) {
            let step = (right.nanoseconds - left.nanoseconds) as f64 * 1e-9;
            supplied += 0.5 * step * (left.supply + right.supply);
            dissipated += 0.5 * step * (left.dissipation + right.dissipation);
            // A valve that steps between two states does so anywhere between them: the trapezoid's error is spread evenly over
            // the step of the power, once to each side.
            between += (step * (right.supply + right.dissipation - left.supply - left.dissipation)).powi(2) / 12.0;
            through += 0.5 * step * (left.supply.abs() + right.supply.abs());
            through += 0.5 * step * (left.dissipation.abs() + right.dissipation.abs());
        }
        // The energies at both ends carry their own noise; the noise of the powers averages out over the window.
        let stored_noise = noise(self.points.iter().map(|point| point.stored));
        let power_noise = noise(self.points.iter().map(|point| point.supply + point.dissipation));
        let size = self.points.iter().map(|point| point.size).fold(0.0, f64::max);
        let step = length / (self.points.len() - 1) as f64;
        let variance = 2.0 * stored_noise.powi(2) + power_noise.powi(2) * step * length + between;
        Some(Window {
            nanoseconds: last.nanoseconds,
            length,
            stored: last.stored - first.stored,
            supplied,
            dissipated,
            standard_error: variance.sqrt(),
            significance: self.settings.significance,
            resolution: SHARE * through + ROUNDING * size,
        })
    }
}

/// Standard deviation of the white noise on a smooth signal.
fn noise(values: impl Iterator<Item = f64>) -> f64 {
    crate::recording::noise_level(&values.collect::<Vec<f64>>())
}
