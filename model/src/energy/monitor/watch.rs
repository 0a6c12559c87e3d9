//! Decides whether the model explains the energy balance, and whether the balance is physically possible.

use std::collections::VecDeque;

use super::Balance;

/// Settings of the watch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WatchSettings {
    /// Time over which powers are averaged, s. 1 s: long compared with the noise of a differentiated energy, short compared
    /// with a work cycle.
    pub window: f64,
    /// Standard errors that a mean residual must exceed. 5: with one window per second, white noise causes one false alarm in
    /// twenty days.
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
    /// Energy that the effects of the model add, J; negative = dissipated.
    pub dissipated: f64,
    /// Standard error of `stored - supplied - dissipated`, J, from signal noise and from changes between two states.
    pub standard_error: f64,
    /// Significance required.
    pub significance: f64,
    /// Resolution of `stored - supplied - dissipated`, J: a smaller value means nothing.
    pub resolution: f64,
}

/// Fraction of the energy throughput that a balance cannot resolve, because of changes between two states, above all steps of
/// a valve. Simulator and monitor of the same model leave up to 0.3 % at 1 kHz; sensors are worse.
const SHARE: f64 = 5e-3;
/// Fraction of the stored energy below which its change is not resolved: the error of an integration with a relative tolerance
/// of 1e-6, a hundred times less than that of the best pressure transducers.
const ROUNDING: f64 = 1e-6;

impl Window {
    /// Mean power that the model does not explain, W.
    pub fn residual(&self) -> f64 {
        (self.stored - self.supplied - self.dissipated) / self.length
    }

    /// Limit of the mean residual that noise alone does not exceed, but at least the resolution of the balance, W.
    ///
    /// Noise is propagated through the linearised balance. Where the pressure drop over a valve is smaller than the noise of
    /// the pressure sensors, the square root is strongly nonlinear and the supplied power is biased. The residual may then
    /// exceed this limit without any missing physics.
    pub fn threshold(&self) -> f64 {
        self.least() / self.length
    }

    /// Energy that noise and resolution can explain, J.
    fn least(&self) -> f64 {
        (self.significance * self.standard_error).max(self.resolution)
    }

    /// Whether noise explains the residual.
    pub fn is_explained(&self) -> bool {
        self.residual().abs() <= self.threshold()
    }

    /// Whether more energy was stored than supplied, beyond the noise. No passive machine does that, so an instrument or the
    /// supply side of the model is wrong.
    pub fn violates_passivity(&self) -> bool {
        self.stored - self.supplied > self.least()
    }
}

/// Collects balances and evaluates them window by window.
#[derive(Debug)]
pub struct Watch {
    settings: WatchSettings,
    points: VecDeque<Point>,
}

#[derive(Debug, Clone, Copy)]
struct Point {
    nanoseconds: i64,
    stored: f64,
    /// Sum of the absolute stored energies.
    size: f64,
    supply: f64,
    dissipation: f64,
}

/// Fewest balances in a window that is evaluated.
const FEWEST: usize = 20;
/// A longer pause between balances discards the window, ns.
const GAP: i64 = 200_000_000;

impl Watch {
    /// A watch without any balances yet.
    pub fn new(settings: WatchSettings) -> Self {
        Watch { settings, points: VecDeque::new() }
    }

    /// Adds a balance; returns a window when one is full. Incomplete balances are skipped.
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
            // A valve may step anywhere between two states. So the trapezoid's error is uniformly distributed over the step of
            // the power, on both sides.
            between += (step * (right.supply + right.dissipation - left.supply - left.dissipation)).powi(2) / 12.0;
            through += 0.5 * step * (left.supply.abs() + right.supply.abs());
            through += 0.5 * step * (left.dissipation.abs() + right.dissipation.abs());
        }
        // The energies at both ends carry their own noise; the noise of the powers averages out over the window.
        let stored_noise = noise(self.points.iter().map(|point| point.stored));
        let powers = || self.points.iter().map(|point| point.supply + point.dissipation);
        let power_noise = noise(powers());
        let size = self.points.iter().map(|point| point.size).fold(0.0, f64::max);
        let step = length / (self.points.len() - 1) as f64;
        // A command whose rhythm is that of the states steps at the same place between them every time. Then the errors of the
        // trapezoids add up while the power rises, instead of averaging out.
        let rise = powers().fold(f64::NEG_INFINITY, f64::max) - powers().fold(f64::INFINITY, f64::min);
        let variance = 2.0 * stored_noise.powi(2) + power_noise.powi(2) * step * length + between;
        Some(Window {
            nanoseconds: last.nanoseconds,
            length,
            stored: last.stored - first.stored,
            supplied,
            dissipated,
            standard_error: variance.sqrt(),
            significance: self.settings.significance,
            resolution: SHARE * through + ROUNDING * size + 0.5 * step * rise,
        })
    }
}

/// Standard deviation of the white noise on a smooth signal.
fn noise(values: impl Iterator<Item = f64>) -> f64 {
    crate::recording::noise_level(&values.collect::<Vec<f64>>())
}
