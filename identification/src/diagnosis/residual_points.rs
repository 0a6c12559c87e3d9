//! Residuals of a model with the states at which they occur, and binned curves over these.

use std::collections::BTreeMap;

use excavator_model::Model;
use excavator_model::machine::Mechanism;
use excavator_model::recording::Recording;
use excavator_model::simulation::{InputSignals, undistorted};

use crate::regression::{EquationKind, RegressionError, WeakFormSettings, observe, weak_residuals};

/// One weak residual with the state at which it occurs.
pub(super) struct Point {
    pub kind: EquationKind,
    /// Number of the recording, and of the sample in the middle of the window.
    pub place: (usize, usize),
    /// In units of the sensor noise.
    pub weighed: f64,
    /// Mean over the window, in the equation's unit.
    pub residual: f64,
    pub opening: f64,
    pub velocity: f64,
    pub displacement: f64,
    pub cap_pressure: f64,
    pub rod_pressure: f64,
    pub pump_pressure: f64,
    pub time: f64,
}

/// Equation, recording and sample: identifies the same residual in two models.
pub(super) type Key = (EquationKind, (usize, usize));

impl Point {
    /// Identifies the residual.
    pub fn key(&self) -> Key {
        (self.kind, self.place)
    }
}

/// A quantity that a residual may depend on.
pub(super) type Variable = fn(&Point) -> f64;

/// Variables that residuals are plotted against.
pub(super) const VARIABLES: [(&str, Variable); 7] = [
    ("command", |p| p.opening),
    ("speed", |p| p.velocity),
    ("position", |p| p.displacement),
    ("cap_pressure", |p| p.cap_pressure),
    ("rod_pressure", |p| p.rod_pressure),
    ("pump_pressure", |p| p.pump_pressure),
    ("time", |p| p.time),
];

/// Unit of an equation's residual: N m, N for a load without joint, or m³/s.
pub(super) fn unit_of(kind: EquationKind, model: &Model) -> &'static str {
    match (kind, &model.machine.mechanism) {
        (EquationKind::Motion(_), Mechanism::LinearLoad) => "N",
        (EquationKind::Motion(_), _) => "N m",
        _ => "m3/s",
    }
}

/// All weak residuals of `model` for the recordings.
///
/// # Errors
/// [`RegressionError`] if the recordings lack inputs.
pub(super) fn points(model: &Model, recordings: &[&Recording]) -> Result<Vec<Point>, RegressionError> {
    // No velocity guard: failures near standstill must be visible.
    let settings = WeakFormSettings { velocity_guard: 0.0, ..WeakFormSettings::default() };
    let mut points = Vec::new();
    for (number, recording) in recordings.iter().enumerate() {
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
                place: (number, residual.sample),
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

/// Mean squared residual of each equation, in units of the noise variance.
pub(super) fn mean_squares(points: &[Point]) -> Vec<(EquationKind, f64)> {
    let mut sums: BTreeMap<EquationKind, (f64, usize)> = BTreeMap::new();
    for point in points {
        let (sum, count) = sums.entry(point.kind).or_default();
        *sum += point.weighed * point.weighed;
        *count += 1;
    }
    sums.into_iter().map(|(kind, (sum, count))| (kind, sum / count as f64)).collect()
}

fn busiest(inputs: &InputSignals, sample: usize, cylinders: usize) -> usize {
    (0..cylinders)
        .max_by(|&a, &b| inputs.orifice_area(a)[sample].abs().total_cmp(&inputs.orifice_area(b)[sample].abs()))
        .unwrap_or(0)
}

/// Bins of a curve over a variable, each with the same number of points.
pub(super) const BINS: usize = 24;

/// Neighbouring points along a variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bin {
    /// Mean of the variable.
    pub at: f64,
    /// Number of points.
    pub count: f64,
    /// Mean of the binned values.
    pub mean: f64,
    /// Its variance inside the bin.
    pub variance: f64,
    /// Mean of its square.
    pub mean_square: f64,
}

impl Bin {
    /// Standard error of the mean.
    pub fn standard_error(&self) -> f64 {
        (self.variance / self.count).sqrt()
    }
}

/// Bins of `(variable, value)` pairs; `None` if there are too few pairs, or if the variable is constant, which would bin by time.
pub(super) fn bins(mut pairs: Vec<(f64, f64)>) -> Option<Vec<Bin>> {
    pairs.retain(|pair| pair.0.is_finite());
    if pairs.len() < 4 * BINS {
        return None;
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    if pairs[0].0 == pairs[pairs.len() - 1].0 {
        return None;
    }
    let bin = |number: usize| {
        let members = &pairs[number * pairs.len() / BINS..(number + 1) * pairs.len() / BINS];
        let count = members.len() as f64;
        let mean = members.iter().map(|pair| pair.1).sum::<f64>() / count;
        Bin {
            at: members.iter().map(|pair| pair.0).sum::<f64>() / count,
            count,
            mean,
            variance: members.iter().map(|pair| (pair.1 - mean).powi(2)).sum::<f64>() / (count - 1.0),
            mean_square: members.iter().map(|pair| pair.1 * pair.1).sum::<f64>() / count,
        }
    };
    Some((0..BINS).map(bin).collect())
}

/// Share of the squared values that the bin means explain, beyond the share expected from noise.
pub(super) fn share_explained(bins: &[Bin]) -> f64 {
    let total: f64 = bins.iter().map(|bin| bin.count * bin.mean_square).sum();
    let explained: f64 = bins.iter().map(|bin| bin.count * bin.mean * bin.mean - bin.variance).sum();
    if total > 0.0 { (explained / total).max(0.0) } else { 0.0 }
}
