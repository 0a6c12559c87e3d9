//! Energy of compressible oil as a function of pressure.

use crate::scalar::Scalar;

/// Energy of oil at one pressure, from its compressibility c(p).
///
/// The power that a flow Q carries into a chamber is `e Q`, where `de/dp = 1 + c(p) e`, `e(0) = 0`; the chamber stores
/// `V h` with `h = e - p`. With these, `d(V h)/dt = e Q - p dV/dt` follows from the continuity equation for any c(p). A
/// constant `c = 1/b` gives `e = b (exp(p/b) - 1)` and the storage of \[A\] Eq. 9.
#[derive(Debug, Clone, Copy, PartialEq)]
#[must_use]
pub struct OilEnergy<T> {
    /// Energy h stored per volume, J/m³.
    pub stored: T,
    /// Energy e carried into the chamber per volume of flow, J/m³ (equals the pressure for stiff oil).
    pub potential: T,
}

/// Below this `|c p|` the code sums the series of `exp(x) - 1 - x`, because the closed form suffers from cancellation.
const SERIES_BELOW: f64 = 0.1;

/// Terms of that series; the first one left out is below 1e-17 of the first.
const SERIES_TERMS: i32 = 13;

impl<T: Scalar> OilEnergy<T> {
    /// At `pressure` (Pa), for a compressibility (1/Pa) that does not depend on pressure: \[A\] Eq. 9.
    pub fn of_constant(compressibility: T, pressure: T) -> Self {
        let strain = compressibility * pressure;
        // (exp(x) - 1 - x) / (x²/2), which is 1 for stiff oil.
        let bend = if strain.value().abs() < SERIES_BELOW {
            (3..=SERIES_TERMS).rev().fold(T::from(1.0), |sum, term| sum * strain / f64::from(term) + 1.0)
        } else {
            (strain.exp_m1() - strain) * 2.0 / (strain * strain)
        };
        Self::from_stored(compressibility * pressure * pressure * 0.5 * bend, pressure)
    }

    /// At `pressure` (Pa), for a compressibility (1/Pa) that depends on pressure.
    ///
    /// Integrates `dh/dp = c (p + h)` from zero, which avoids the cancellation of `e - p`. It uses panels of sixth-order Gauss
    /// quadrature over the logarithm of the absolute pressure, in which gas laws are smooth.
    pub fn of_varying(mut compressibility: impl FnMut(T) -> T, pressure: T) -> Self {
        let zero = T::from(0.0);
        let lowest = T::from(-GAS_LAW_DOWN_TO * AMBIENT);
        let within = if pressure.value() > lowest.value() { pressure } else { lowest };
        let mut stored = integrate(zero, (within / AMBIENT).ln_1p(), zero, |height| {
            let pressure = height.exp_m1() * AMBIENT;
            (pressure, (pressure + AMBIENT) * compressibility(pressure))
        });
        if pressure.value() < lowest.value() {
            stored = integrate(lowest / AMBIENT, pressure / AMBIENT, stored, |height| {
                let pressure = height * AMBIENT;
                (pressure, compressibility(pressure) * AMBIENT)
            });
        }
        Self::from_stored(stored, pressure)
    }

    fn from_stored(stored: T, pressure: T) -> Self {
        OilEnergy { stored, potential: stored + pressure }
    }
}

/// Energy (J) that a line stores in a compliance other than its oil: the integral of `e C dp` from zero to `pressure` (Pa), where
/// `at` returns C (m³/Pa) and e (J/m³) at a pressure.
pub fn stored_beside<T: Scalar>(mut at: impl FnMut(T) -> (T, T), pressure: T) -> T {
    let lowest = T::from(-GAS_LAW_DOWN_TO * AMBIENT);
    let within = if pressure.value() > lowest.value() { pressure } else { lowest };
    let height = (within / AMBIENT).ln_1p();
    // The corner at the pre-charge pressure is sharper than a gas law.
    let panels = (2.0 * height.value().abs() / PANEL).ceil().max(1.0) as usize;
    let width = height / panels as f64;
    let nodes = gauss_nodes();
    let mut stored = T::from(0.0);
    for panel in 0..panels {
        for (node, weight) in nodes.into_iter().zip(GAUSS_WEIGHTS) {
            let pressure = (width * (panel as f64 + node)).exp_m1() * AMBIENT;
            let (compliance, potential) = at(pressure);
            stored += compliance * potential * (pressure + AMBIENT) * width * weight;
        }
    }
    stored
}

/// Nodes and weights of Gauss quadrature of sixth order between zero and one.
fn gauss_nodes() -> [f64; 3] {
    let root = 15.0_f64.sqrt();
    [0.5 - root / 10.0, 0.5, 0.5 + root / 10.0]
}
const GAUSS_WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];

/// Ambient pressure, Pa absolute.
const AMBIENT: f64 = 101_325.0;

/// Down to this fraction of a vacuum the integration variable is the logarithm of the absolute pressure. Below it, where no oil
/// gets, it is the pressure itself.
const GAS_LAW_DOWN_TO: f64 = 0.99;

/// Longest panel, in units of the logarithm: its error is below 1e-12 of the result.
const PANEL: f64 = 0.05;

/// Integrates `stored` from `from` to `to`, where `at` returns pressure and c(p) dp/dy at a value of the variable y.
fn integrate<T: Scalar>(from: T, to: T, stored: T, mut at: impl FnMut(T) -> (T, T)) -> T {
    let root = 15.0_f64.sqrt();
    // Integrals up to each node of the three-stage Gauss method.
    let (nodes, weights) = (gauss_nodes(), GAUSS_WEIGHTS);
    let partial = [
        [5.0 / 36.0, 2.0 / 9.0 - root / 15.0, 5.0 / 36.0 - root / 30.0],
        [5.0 / 36.0 + root / 24.0, 2.0 / 9.0, 5.0 / 36.0 - root / 24.0],
        [5.0 / 36.0 + root / 30.0, 2.0 / 9.0 + root / 15.0, 5.0 / 36.0],
    ];
    let span = to - from;
    let panels = (span.value().abs() / PANEL).ceil().max(1.0) as usize;
    let width = span / panels as f64;
    let mut stored = stored;
    for panel in 0..panels {
        let values = nodes.map(|node| at(from + width * (panel as f64 + node)));
        let sum = |weights: [f64; 3]| {
            (values[0].1 * weights[0] + values[1].1 * weights[1] + values[2].1 * weights[2]) * width
        };
        let mut source = T::from(0.0);
        for (stage, (pressure, rate)) in values.iter().enumerate() {
            source += (-sum(partial[stage])).exp() * *pressure * *rate * weights[stage];
        }
        stored = sum(weights).exp() * (stored + source * width);
    }
    stored
}

#[cfg(test)]
mod tests {
    use super::OilEnergy;

    /// The quadrature does not use exponentials; at a constant compressibility it must match the closed form.
    #[test]
    fn quadrature_agrees_with_the_closed_form() {
        for modulus in [6.5e7, 9.6e8_f64] {
            for pressure in [-9.0e4, -1.0e3, 0.0_f64, 50.0, 2.0e5, 1.0e6, 3.0e7] {
                let closed = OilEnergy::of_constant(1.0 / modulus, pressure);
                let summed = OilEnergy::of_varying(|_| 1.0 / modulus, pressure);
                let difference = (closed.stored - summed.stored).abs();
                assert!(difference <= 1e-11 * closed.stored, "{modulus} {pressure}: {closed:?} {summed:?}");
            }
        }
    }

    /// Series and closed form of `exp(x) - 1 - x` agree where the code switches between them.
    #[test]
    fn series_meets_the_exponential() {
        let (below, above): (f64, f64) = (0.1 - 1e-12, 0.1 + 1e-12);
        let exact = 2.0 * (0.1_f64.exp_m1() - 0.1);
        for strain in [below, above] {
            let stored = 2.0 * OilEnergy::of_constant(1.0, strain).stored;
            assert!((stored / exact - 1.0).abs() < 5e-11, "{strain}: {stored} {exact}");
        }
    }

    /// Compares with `e` from its own differential equation with a gas law, in a hundred thousand small steps of the classical
    /// Runge-Kutta method.
    #[test]
    fn bubbles_are_integrated_exactly() {
        let compressibility = |pressure: f64| {
            1.0 / 9.6e8 + 0.02 / 1.4 * 101_325.0_f64.powf(1.0 / 1.4) / (101_325.0 + pressure).powf(1.0 + 1.0 / 1.4)
        };
        for pressure in [-8.0e4, 3.0e5, 5.0e6] {
            let steps = 100_000;
            let step = pressure / f64::from(steps);
            let mut potential = 0.0;
            for index in 0..steps {
                let at = step * f64::from(index);
                let slope = |part: f64, potential: f64| 1.0 + compressibility(at + part * step) * potential;
                let first = slope(0.0, potential);
                let second = slope(0.5, potential + 0.5 * step * first);
                let third = slope(0.5, potential + 0.5 * step * second);
                let fourth = slope(1.0, potential + step * third);
                potential += step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth);
            }
            let found = OilEnergy::of_varying(compressibility, pressure);
            assert!((found.potential / potential - 1.0).abs() < 1e-10, "{pressure}: {found:?} {potential}");
        }
    }
}
