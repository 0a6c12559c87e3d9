//! Locates where a model fails: in which equation, in which regime, along which variable.

use excavator_model::Model;
use excavator_model::effects::Text;
use excavator_model::recording::Recording;

use super::residual_points::{Point, VARIABLES, bins, mean_squares, points, share_explained, unit_of};
use crate::decision::Policy;
use crate::regression::{EquationKind, RegressionError};

/// Share of the residual in one equation and one regime.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// `arm.motion`, `arm.cap_continuity`, ...
    pub equation: String,
    /// Description: "valve closed", "to cap side, fast", ...
    pub regime: Text,
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
    pub variable: Text,
    /// Fraction of that equation's squared residual that a curve over the variable explains.
    pub share_of_residual: f64,
    /// Whether that is enough to name the variable.
    pub follows_variable: bool,
    /// Whether one effect is most of what is missing, and what it leaves looks like another form of it: it is in a balance of its own
    /// kind and follows one variable.
    pub differs_in_form: bool,
    /// The curve: variable, mean residual, its standard error; both in SI units.
    pub curve: Vec<[f64; 3]>,
    /// Unit of the residual: N m, N for a load without joint, or m³/s.
    pub unit: Text,
}

/// Opening, relative to the largest commanded, below which a valve counts as closed.
const CLOSED: f64 = 0.03;

/// Speed, relative to the fastest, below which a piston counts as slow.
const SLOW: f64 = 0.2;

/// Shares of the residual by equation and regime, largest first. `points` are those of `model`.
pub(super) fn residual_map(model: &Model, points: &[Point]) -> Vec<Share> {
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
    for point in points {
        let name = regime(point);
        let position = shares.iter().position(|(kind, share, _)| *kind == point.kind && share.regime == name);
        let position = position.unwrap_or_else(|| {
            let equation = point.kind.name(model);
            let share = Share { equation, regime: name.into(), share_of_residual: 0.0, share_of_time: 0.0 };
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
    shares
}

/// The curve over one variable that explains most of the residual in the equation with the largest residual.
///
/// # Errors
/// [`RegressionError`] if the recordings lack inputs.
pub fn unexplained(
    model: &Model,
    recordings: &[&Recording],
    policy: &Policy,
) -> Result<Option<Unexplained>, RegressionError> {
    Ok(follows(model, &points(model, recordings)?, policy))
}

/// The same from the residuals of `model`.
pub(super) fn follows(model: &Model, points: &[Point], policy: &Policy) -> Option<Unexplained> {
    let (worst, _) = mean_squares(points).into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let own: Vec<&Point> = points.iter().filter(|point| point.kind == worst).collect();
    let best = VARIABLES
        .into_iter()
        .filter_map(|(variable, of)| {
            let pairs: Vec<(f64, f64)> = own.iter().map(|point| (of(point), point.residual)).collect();
            let bins = bins(pairs)?;
            let curve = bins.iter().map(|bin| [bin.at, bin.mean, bin.standard_error()]).collect();
            Some((variable, share_explained(&bins), curve))
        })
        .max_by(|a, b| a.1.total_cmp(&b.1));
    best.map(|(variable, share_of_residual, curve)| Unexplained {
        equation: worst.name(model),
        variable: variable.into(),
        share_of_residual,
        follows_variable: share_of_residual >= policy.share_of_a_variable,
        differs_in_form: false,
        curve,
        unit: unit_of(worst, model).into(),
    })
}
