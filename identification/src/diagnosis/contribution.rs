//! An effect as the data show it: what its equation lacks without it, against the variable that it depends on.
//!
//! A component-and-residual plot (Larsen and McCleary 1972): the effect is taken out of the fitted model and nothing is
//! fitted again, so that what is left shows the effect itself, and not what other parameters have taken up of it. Where the
//! effect is right the points lie on its line; where another one is missing they have a shape of their own.

use std::collections::BTreeMap;

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::residual_points::{Point, VARIABLES, Variable, bins, points, share_explained, unit_of};
use crate::regression::{EquationKind, RegressionError};
use crate::search::{Addition, Trial};

/// An effect in the equation and along the variable in which it shows most clearly.
#[derive(Debug, Clone, PartialEq)]
pub struct Contribution {
    /// `arm.motion`, `arm.cap_continuity`, ...
    pub equation: String,
    /// The variable that what the effect does follows most closely.
    pub variable: &'static str,
    /// Unit of what the equation lacks: N m, N for a load without joint, or m³/s.
    pub unit: &'static str,
    /// Share of what the effect does, squared, that a curve over the variable explains.
    pub share: f64,
    /// Along the variable, SI units.
    pub bins: Vec<ContributionBin>,
}

/// Neighbours along the variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContributionBin {
    /// Mean of the variable.
    pub at: f64,
    /// What the equation lacks without the effect, on average.
    pub lacking: f64,
    /// Standard error of that.
    pub standard_error: f64,
    /// What the fitted effect gives, on average.
    pub effect: f64,
}

/// Least share of what an effect does that a curve must explain to be worth a picture.
const LEAST_SHARE: f64 = 0.2;

/// How an addition to the fitted model of `trial` shows on the validation recordings. `None` where no equation is changed by it, or by nothing that one variable tells.
///
/// # Errors
/// [`RegressionError`] when the recordings lack inputs.
pub fn contribution(
    trial: &Trial,
    addition: &Addition,
    recordings: &[&Recording],
) -> Result<Option<Contribution>, RegressionError> {
    let with = &trial.model_on_validation();
    let mut without = with.clone();
    without.effects.retain(|effect| !effect.is(&addition.physics.card().name, addition.site));
    let with: BTreeMap<_, f64> =
        points(with, recordings)?.into_iter().map(|point| ((point.kind, point.place), point.residual)).collect();
    let pairs: Vec<(Point, f64)> = points(&without, recordings)?
        .into_iter()
        .filter_map(|point| {
            let effect = point.residual - with.get(&(point.kind, point.place))?;
            (point.residual.is_finite() && effect.is_finite()).then_some((point, effect))
        })
        .collect();
    Ok(clearest_equation(&pairs).and_then(|kind| along_its_variable(kind, &pairs, &without)))
}

/// The equation in which the effect does most, in units of noise.
fn clearest_equation(pairs: &[(Point, f64)]) -> Option<EquationKind> {
    let mut sums: BTreeMap<EquationKind, f64> = BTreeMap::new();
    for (point, effect) in pairs.iter().filter(|(point, _)| point.residual != 0.0) {
        *sums.entry(point.kind).or_default() += (point.weighed / point.residual * effect).powi(2);
    }
    let mut sums: Vec<(EquationKind, f64)> = sums.into_iter().filter(|(_, sum)| *sum > 0.0).collect();
    sums.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    sums.first().map(|(kind, _)| *kind)
}

fn along_its_variable(kind: EquationKind, pairs: &[(Point, f64)], model: &Model) -> Option<Contribution> {
    let own: Vec<&(Point, f64)> = pairs.iter().filter(|(point, _)| point.kind == kind).collect();
    let along = |of: Variable, value: &dyn Fn(&(Point, f64)) -> f64| {
        bins(own.iter().map(|pair| (of(&pair.0), value(pair))).collect())
    };
    let (share, variable, effect, of) = VARIABLES
        .into_iter()
        .filter_map(|(variable, of)| {
            let effect = along(of, &|pair| pair.1)?;
            Some((share_explained(&effect), variable, effect, of))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    let lacking = along(of, &|pair| pair.0.residual)?;
    (share >= LEAST_SHARE).then(|| Contribution {
        equation: kind.name(model),
        variable,
        unit: unit_of(kind, model),
        share,
        bins: lacking
            .iter()
            .zip(&effect)
            .map(|(lacking, effect)| ContributionBin {
                at: lacking.at,
                lacking: lacking.mean,
                standard_error: lacking.standard_error(),
                effect: effect.mean,
            })
            .collect(),
    })
}
