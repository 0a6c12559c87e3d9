//! Where a model fails: in which equation, in which regime, along which variable.

use excavator_model::Model;
use excavator_model::machine::Mechanism;
use excavator_model::recording::Recording;
use excavator_model::simulation::{InputSignals, undistorted};

use crate::regression::{EquationKind, RegressionError, WeakFormSettings, observe, weak_residuals};

/// Share of the residual in one equation and one regime.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// `arm.motion`, `arm.cap_continuity`, ...
    pub equation: String,
    /// In words: "valve closed", "to cap side, fast", ...
    pub regime: &'static str,
    /// Fraction of the squared residual (in units of noise) of all equations.
    pub share_of_residual: f64,
    /// Fraction of the time.
    pub share_of_time: f64,
}

/// A residual that no known effect explains.
#[derive(Debug, Clone, PartialEq)]
pub struct Unexplained {
    /// The equation with the largest residual.
    pub equation: String,
    /// The variable that it follows most closely.
    pub variable: &'static str,
    /// Fraction of that equation's squared residual that a curve over the variable explains.
    pub share_of_residual: f64,
    /// The curve: variable, mean residual, its standard error; both in SI units.
    pub curve: Vec<[f64; 3]>,
    /// Unit of the residual: N m, N for a load without joint, or m³/s.
    pub unit: &'static str,
}

/// One weak residual with the state around it.
struct Point {
    kind: EquationKind,
    /// In units of what sensor noise explains.
    weighed: f64,
    /// Mean over the window, in the equation's unit.
    residual: f64,
    opening: f64,
    velocity: f64,
    displacement: f64,
    cap_pressure: f64,
    rod_pressure: f64,
    pump_pressure: f64,
    time: f64,
}

/// Opening, relative to the largest commanded, below which a valve counts as closed.
const CLOSED: f64 = 0.03;

/// Speed, relative to the fastest, below which a piston counts as slow.
const SLOW: f64 = 0.2;

fn points(model: &Model, recordings: &[&Recording]) -> Result<Vec<Point>, RegressionError> {
    // No guard: where a model fails near standstill is part of the answer.
    let settings = WeakFormSettings { velocity_guard: 0.0, ..WeakFormSettings::default() };
    let mut points = Vec::new();
    for recording in recordings {
        let observation = observe(model, &undistorted(model, recording))?;
        let inputs = InputSignals::from_recording(model, recording)?;
        for residual in weak_residuals(model, recording, &settings)? {
            let cylinder = match residual.kind {
                EquationKind::Motion(c) | EquationKind::CapContinuity(c) | EquationKind::RodContinuity(c) => c,
                EquationKind::PumpContinuity => busiest(&inputs, residual.sample, model.machine.cylinders.len()),
            };
            let seen = &observation.cylinders[cylinder];
            points.push(Point {
                kind: residual.kind,
                weighed: residual.in_noise_units,
                residual: residual.mean,
                opening: inputs.orifice_area(cylinder)[residual.sample],
                velocity: seen.velocity[residual.sample],
                displacement: seen.smooth_displacement[residual.sample],
                cap_pressure: seen.smooth_pressures[0][residual.sample],
                rod_pressure: seen.smooth_pressures[1][residual.sample],
                pump_pressure: observation.smooth_pump_pressure[residual.sample],
                time: recording.time[residual.sample],
            });
        }
    }
    Ok(points)
}

fn busiest(inputs: &InputSignals, sample: usize, cylinders: usize) -> usize {
    (0..cylinders)
        .max_by(|&a, &b| inputs.orifice_area(a)[sample].abs().total_cmp(&inputs.orifice_area(b)[sample].abs()))
        .unwrap_or(0)
}

/// Shares of the residual by equation and regime, largest first.
///
/// # Errors
/// [`RegressionError`] when the recordings lack inputs.
pub fn residual_map(model: &Model, recordings: &[&Recording]) -> Result<Vec<Share>, RegressionError> {
    let points = points(model, recordings)?;
    let largest = |of: fn(&Point) -> f64| points.iter().map(|point| of(point).abs()).fold(0.0, f64::max);
    let (largest_opening, fastest) = (largest(|p| p.opening), largest(|p| p.velocity));
    let regime = |point: &Point| {
        let slow = point.velocity.abs() < SLOW * fastest;
        if largest_opening > 0.0 && point.opening.abs() < CLOSED * largest_opening {
            "valve closed"
        } else if largest_opening == 0.0 {
            match (slow, point.velocity > 0.0) {
                (true, _) => "slow",
                (false, true) => "extending",
                (false, false) => "retracting",
            }
        } else {
            match (point.opening > 0.0, slow) {
                (true, true) => "to cap side, slow",
                (true, false) => "to cap side, fast",
                (false, true) => "to rod side, slow",
                (false, false) => "to rod side, fast",
            }
        }
    };
    let total: f64 = points.iter().map(|point| point.weighed * point.weighed).sum();
    let mut shares: Vec<(EquationKind, Share, usize)> = Vec::new();
    for point in &points {
        let name = regime(point);
        let position = shares.iter().position(|(kind, share, _)| *kind == point.kind && share.regime == name);
        let position = position.unwrap_or_else(|| {
            let equation = point.kind.name(model);
            let share = Share { equation, regime: name, share_of_residual: 0.0, share_of_time: 0.0 };
            shares.push((point.kind, share, 0));
            shares.len() - 1
        });
        shares[position].1.share_of_residual += point.weighed * point.weighed / total;
        shares[position].2 += 1;
    }
    let kinds = |wanted: EquationKind| points.iter().filter(|point| point.kind == wanted).count() as f64;
    let mut shares: Vec<Share> = shares
        .into_iter()
        .map(|(kind, share, count)| Share { share_of_time: count as f64 / kinds(kind), ..share })
        .collect();
    shares.sort_by(|a, b| b.share_of_residual.total_cmp(&a.share_of_residual));
    Ok(shares)
}

/// Bins of a curve over a variable, each with the same number of points.
const BINS: usize = 24;

/// The curve over one variable that explains most of the residual of the equation that fails most.
///
/// # Errors
/// [`RegressionError`] when the recordings lack inputs.
pub fn unexplained(model: &Model, recordings: &[&Recording]) -> Result<Option<Unexplained>, RegressionError> {
    let points = points(model, recordings)?;
    let mut kinds: Vec<EquationKind> = points.iter().map(|point| point.kind).collect();
    kinds.sort();
    kinds.dedup();
    let mean_square = |kind: EquationKind| {
        let own = || points.iter().filter(move |point| point.kind == kind);
        own().map(|point| point.weighed * point.weighed).sum::<f64>() / own().count().max(1) as f64
    };
    let Some(worst) = kinds.into_iter().max_by(|a, b| mean_square(*a).total_cmp(&mean_square(*b))) else {
        return Ok(None);
    };
    type Variable = fn(&Point) -> f64;
    let variables: [(&'static str, Variable); 7] = [
        ("command", |p| p.opening),
        ("speed", |p| p.velocity),
        ("position", |p| p.displacement),
        ("cap_pressure", |p| p.cap_pressure),
        ("rod_pressure", |p| p.rod_pressure),
        ("pump_pressure", |p| p.pump_pressure),
        ("time", |p| p.time),
    ];
    let own: Vec<&Point> = points.iter().filter(|point| point.kind == worst).collect();
    let best = variables
        .into_iter()
        .filter_map(|(variable, of)| {
            let (share, curve) = curve(&own, of)?;
            Some((variable, share, curve))
        })
        .max_by(|a, b| a.1.total_cmp(&b.1));
    Ok(best.map(|(variable, share_of_residual, curve)| Unexplained {
        equation: worst.name(model),
        variable,
        share_of_residual,
        curve,
        unit: match (worst, &model.machine.mechanism) {
            (EquationKind::Motion(_), Mechanism::LinearLoad) => "N",
            (EquationKind::Motion(_), _) => "N m",
            _ => "m3/s",
        },
    }))
}

/// Share of squared residual that means over bins of a variable explain, and the means.
fn curve(points: &[&Point], of: fn(&Point) -> f64) -> Option<(f64, Vec<[f64; 3]>)> {
    let mut sorted: Vec<(f64, f64)> =
        points.iter().map(|point| (of(point), point.residual)).filter(|pair| pair.0.is_finite()).collect();
    if sorted.len() < 4 * BINS {
        return None;
    }
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Bins of a variable that stands still would be bins of time.
    if sorted[0].0 == sorted[sorted.len() - 1].0 {
        return None;
    }
    let total: f64 = sorted.iter().map(|pair| pair.1 * pair.1).sum();
    let mut explained = 0.0;
    let mut curve = Vec::with_capacity(BINS);
    for bin in 0..BINS {
        let members = &sorted[bin * sorted.len() / BINS..(bin + 1) * sorted.len() / BINS];
        let count = members.len() as f64;
        let mean = members.iter().map(|pair| pair.1).sum::<f64>() / count;
        let variance = members.iter().map(|pair| (pair.1 - mean).powi(2)).sum::<f64>() / (count - 1.0);
        explained += count * mean * mean - variance;
        curve.push([members.iter().map(|pair| pair.0).sum::<f64>() / count, mean, (variance / count).sqrt()]);
    }
    (total > 0.0).then(|| ((explained / total).max(0.0), curve))
}
