//! Integrates one equation against one test function.

use excavator_model::machine::Linkage;
use nalgebra::DVector;

use super::Observation;
use super::equation::{Equation, EquationKind, Sensor, Term};
use super::sensor_noise::SensorNoise;
use super::window::Window;

/// Residual of an equation against a test function, with its regressors.
pub(super) struct WeakRow {
    /// `sum of terms - rest`.
    pub residual: f64,
    /// Standard deviation of the residual due to sensor noise.
    pub noise: f64,
    /// Size of its parts, for a relative residual.
    pub size: f64,
    /// Derivative by each fitted parameter.
    pub regressors: DVector<f64>,
}

/// Half width of the difference quotient for a storage's rate of change, s. It is wide because storage changes slowly with
/// the stroke, but noise is fast: ten samples at 500 Hz. Longer, it blurs the compliance of oil with air.
const STORAGE_SLOPE: f64 = 0.02;

/// Weights that integrate `bump * storage * d^order quantity` by parts, per sample of the window.
fn parts(term_order: usize, window: &Window, storage: &[f64], time: &[f64]) -> Vec<f64> {
    let interval = (time[time.len() - 1] - time[0]) / (time.len() - 1).max(1) as f64;
    let reach = ((STORAGE_SLOPE / interval).round() as usize).clamp(1, time.len() - 1);
    let slope = |index: usize, values: &dyn Fn(usize) -> f64| {
        let (low, high) = (index.saturating_sub(reach), (index + reach).min(time.len() - 1));
        (values(high) - values(low)) / (time[high] - time[low])
    };
    let constant = window.weights.len() < 2
        || storage[window.first..window.first + window.weights.len()].windows(2).all(|pair| pair[0] == pair[1]);
    window
        .weights
        .iter()
        .enumerate()
        .map(|(offset, [value, first, second])| {
            let index = window.first + offset;
            let c = storage[index];
            if term_order == 1 {
                let rate = if constant { 0.0 } else { slope(index, &|i| storage[i]) };
                -(first * c + value * rate)
            } else if constant {
                second * c
            } else {
                let rate = slope(index, &|i| storage[i]);
                let curvature = slope(index, &|i| slope(i, &|j| storage[j]));
                second * c + 2.0 * first * rate + value * curvature
            }
        })
        .collect()
}

fn integral(weights: &[f64], window: &Window, quantity: &[f64]) -> f64 {
    // A constant may be subtracted before a derivative. The value in the middle of the window keeps errors of rounding
    // and quadrature small.
    let reference = quantity[window.first + weights.len() / 2];
    weights.iter().zip(&quantity[window.first..]).map(|(weight, value)| weight * (value - reference)).sum()
}

/// The row of `equation` for `window`, or `None` if a signal that it needs is not measured inside the window.
pub(super) fn weak_row(
    equation: &Equation,
    window: &Window,
    observation: &Observation,
    noise: &SensorNoise,
    linkages: &[Linkage],
    parameters: usize,
) -> Option<WeakRow> {
    let samples = window.first..window.first + window.weights.len();
    if !equation.rest[samples.clone()].iter().all(|value| value.is_finite()) {
        return None;
    }
    let mut regressors = DVector::zeros(parameters);
    let mut residual = 0.0;
    let mut size = 0.0;
    let sensors = Sensor::all(linkages.len());
    let mut by_sensor: Vec<Vec<f64>> = vec![Vec::new(); sensors.len()];
    for term in &equation.terms {
        if !term.quantity[samples.clone()].iter().all(|value| value.is_finite()) {
            return None;
        }
        let weights = parts(term.order, window, &term.storage, &observation.time);
        let value = integral(&weights, window, &term.quantity);
        residual += value;
        size += value * value;
        for (parameter, column) in term.by_parameter.iter().enumerate().filter(|(_, column)| !column.is_empty()) {
            let weights = parts(term.order, window, column, &observation.time);
            regressors[parameter] += integral(&weights, window, &term.quantity);
        }
        add_noise(equation, term, &weights, window, observation, linkages, &sensors, &mut by_sensor);
    }
    let rest: f64 =
        window.weights.iter().zip(&equation.rest[samples.clone()]).map(|([value, ..], rest)| value * rest).sum();
    residual -= rest;
    size += rest * rest;
    for (parameter, column) in equation.rest_by_parameter.iter().enumerate().filter(|(_, column)| !column.is_empty()) {
        let value: f64 =
            window.weights.iter().zip(&column[samples.clone()]).map(|([value, ..], slope)| value * slope).sum();
        regressors[parameter] -= value;
    }
    for ((sensor, column), total) in sensors.iter().zip(&equation.rest_by_sensor).zip(&mut by_sensor) {
        if column.is_empty() {
            continue;
        }
        total.resize(window.weights.len(), 0.0);
        for ((slot, [value, first, _]), slope) in total.iter_mut().zip(&window.weights).zip(&column[samples.clone()]) {
            // A velocity is the derivative of a displacement. After integration by parts its noise enters with the test
            // function's slope.
            *slot += if matches!(sensor, Sensor::Velocity(_)) { first * slope } else { -value * slope };
        }
    }
    let variance: f64 = sensors
        .iter()
        .zip(&by_sensor)
        .map(|(sensor, weights)| {
            let deviation = match *sensor {
                Sensor::Velocity(c) => noise.displacement[c],
                Sensor::CapPressure(c) => noise.pressures[c][0],
                Sensor::RodPressure(c) => noise.pressures[c][1],
                Sensor::Spool(c) => noise.spool[c],
                Sensor::PumpPressure => noise.pump_pressure,
            };
            deviation * deviation * weights.iter().map(|weight| weight * weight).sum::<f64>()
        })
        .sum();
    // Rates of storage use samples beyond the window, where a signal may have ended.
    let whole = residual.is_finite()
        && variance > 0.0
        && variance.is_finite()
        && regressors.iter().all(|slope: &f64| slope.is_finite());
    whole.then(|| WeakRow { residual, noise: variance.sqrt(), size: size.sqrt(), regressors })
}

#[allow(clippy::too_many_arguments)]
fn add_noise(
    equation: &Equation,
    term: &Term,
    weights: &[f64],
    window: &Window,
    observation: &Observation,
    linkages: &[Linkage],
    sensors: &[Sensor],
    by_sensor: &mut [Vec<f64>],
) {
    // Storage terms of motion are in joint coordinates of a cylinder. Continuity uses the displacement of the piston
    // itself.
    let cylinder = match (equation.kind, term.sensor) {
        (EquationKind::Motion(_), Sensor::Velocity(c)) => Some(c),
        _ => None,
    };
    let Some(position) = sensors.iter().position(|sensor| *sensor == term.sensor) else { return };
    let total = &mut by_sensor[position];
    total.resize(weights.len(), 0.0);
    for (offset, (slot, weight)) in total.iter_mut().zip(weights).enumerate() {
        let factor = cylinder.map_or(1.0, |c| {
            let linkage = &linkages[c];
            1.0 / linkage.lever(linkage.joint(observation.cylinders[c].smooth_displacement[window.first + offset]))
        });
        *slot += weight * factor;
    }
}
