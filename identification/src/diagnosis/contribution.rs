//! Shows an effect in the data: the residual of its equation without the effect, against the variable that it depends on.
//!
//! A component-and-residual plot (Larsen and McCleary 1972): the effect is removed from the fitted model without a refit. The
//! residual then shows the effect itself, and other parameters cannot absorb any of it. If the effect is right, the points lie on
//! its line; if a different one is missing, they have another shape.
//!
//! Textbooks plot friction as the whole force against speed, and valve effects as effective opening against commanded opening. If
//! the model has the nominal law, the plot follows the textbook.

use std::collections::BTreeMap;

use excavator_model::Model;
use excavator_model::effects::{ActsOn, Site};
use excavator_model::recording::Recording;

use super::residual_points::{Bin, Key, Point, VARIABLES, Variable, bins, points, share_explained, unit_of};
use crate::regression::{EquationKind, RegressionError};
use crate::search::{Addition, Trial};

/// An effect in the equation and along the variable where it is most visible.
#[derive(Debug, Clone, PartialEq)]
pub struct Contribution {
    /// `arm.motion`, `arm.cap_continuity`, ...
    pub equation: String,
    /// The variable that the effect follows most closely.
    pub variable: &'static str,
    /// The plotted quantity.
    pub drawn: Drawn,
    /// Unit of the plotted quantity: N m, N for a load without joint, m³/s, or m² for an opening.
    pub unit: &'static str,
    /// Share of the effect's square that a curve over the variable explains.
    pub share: f64,
    /// Bins along the variable, SI units.
    pub bins: Vec<ContributionBin>,
}

/// How a textbook plots an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drawn {
    /// Residual of the equation, and the effect.
    Residual,
    /// Total friction, with the nominal one.
    Friction,
    /// The effective opening, with the nominal one, which is the command.
    Opening,
}

/// Neighbouring points along the variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContributionBin {
    /// Mean of the variable.
    pub at: f64,
    /// Contribution of the nominal effects; 0 for [`Drawn::Residual`].
    pub nominal: f64,
    /// Mean residual without the effect.
    pub lacking: f64,
    /// Standard error of that mean.
    pub standard_error: f64,
    /// Mean contribution of the fitted effect.
    pub effect: f64,
}

/// Smallest share of an effect that a curve must explain for a useful plot.
const LEAST_SHARE: f64 = 0.2;

/// Smallest flow per opening, as a share of the largest, at which a flow determines an opening: without a pressure drop there is
/// no flow.
const LEAST_SLOPE: f64 = 0.05;

/// Fewest openings for a plot.
const LEAST_BINS: usize = 8;

/// Shows an addition to the fitted model of `trial` on the validation recordings. `None` if it changes no equation, or if no
/// single variable explains its change.
///
/// # Errors
/// [`RegressionError`] if the recordings lack inputs.
pub fn contribution(
    trial: &Trial,
    addition: &Addition,
    recordings: &[&Recording],
) -> Result<Option<Contribution>, RegressionError> {
    let with = &trial.model_on_validation();
    let mut without = with.clone();
    without.effects.retain(|effect| !effect.is(&addition.physics.card().name, addition.site));
    let (with, residuals) = (residuals(with, recordings)?, points(&without, recordings)?);
    let pairs: Vec<(Point, f64)> = residuals
        .into_iter()
        .filter_map(|point| {
            let effect = point.residual - with.get(&point.key())?;
            (point.residual.is_finite() && effect.is_finite()).then_some((point, effect))
        })
        .collect();
    let Some(kind) = clearest_equation(&pairs, addition) else { return Ok(None) };
    let Some(shown) = along_its_variable(kind, &pairs, &without, shifts_an_opening(addition)) else { return Ok(None) };
    let drawn = textbook(kind, &shown, addition);
    let nominal = without.clone();
    let is_nominal = |name: &str| nominal_effects(drawn).contains(&name);
    let place = site_of(kind);
    without.effects.retain(|effect| !(is_nominal(effect.name()) && Some(effect.site) == place));
    if without.effects.len() == nominal.effects.len() {
        return Ok(Some(shown));
    }
    let bare = self::residuals(&without, recordings)?;
    Ok(Some(with_nominal(kind, shown, drawn, &pairs, &bare)))
}

/// Residuals of a model by equation and place.
fn residuals(model: &Model, recordings: &[&Recording]) -> Result<BTreeMap<Key, f64>, RegressionError> {
    Ok(points(model, recordings)?.into_iter().map(|point| (point.key(), point.residual)).collect())
}

/// How a textbook plots such an effect.
fn textbook(kind: EquationKind, shown: &Contribution, addition: &Addition) -> Drawn {
    match (kind, shown.variable) {
        (EquationKind::Motion(_), "speed") => Drawn::Friction,
        (EquationKind::CapContinuity(_) | EquationKind::RodContinuity(_), "command") if shifts_an_opening(addition) => {
            Drawn::Opening
        }
        _ => Drawn::Residual,
    }
}

/// Effects of the nominal model that the plot includes.
fn nominal_effects(drawn: Drawn) -> &'static [&'static str] {
    match drawn {
        Drawn::Residual => &[],
        Drawn::Friction => &["coulomb_friction", "viscous_damping"],
        Drawn::Opening => &["orifice_flow"],
    }
}

fn site_of(kind: EquationKind) -> Option<Site> {
    match kind {
        EquationKind::Motion(c) | EquationKind::CapContinuity(c) | EquationKind::RodContinuity(c) => {
            Some(Site::Cylinder(c))
        }
        EquationKind::PumpContinuity => None,
    }
}

/// The plot with the contribution of the nominal effects; `bare` are the residuals without them.
fn with_nominal(
    kind: EquationKind,
    shown: Contribution,
    drawn: Drawn,
    pairs: &[(Point, f64)],
    bare: &BTreeMap<Key, f64>,
) -> Contribution {
    let own = || pairs.iter().filter(|(point, _)| point.kind == kind);
    let nominal = |point: &Point| bare.get(&point.key()).map_or(0.0, |bare| bare - point.residual);
    let Some((_, of)) = VARIABLES.into_iter().find(|(name, _)| *name == shown.variable) else { return shown };
    let along = |value: &dyn Fn(&Point) -> f64| bins(own().map(|(point, _)| (of(point), value(point))).collect());
    match drawn {
        Drawn::Residual => shown,
        Drawn::Friction => {
            let Some(friction) = along(&nominal) else { return shown };
            let bins = shown
                .bins
                .iter()
                .zip(&friction)
                .map(|(bin, nominal)| ContributionBin { nominal: nominal.mean, ..*bin });
            Contribution { bins: bins.collect(), drawn, ..shown }
        }
        Drawn::Opening => {
            // Flow per opening, by least squares in each bin; it converts a flow to an opening.
            let (Some(product), Some(square)) =
                (along(&|point| nominal(point) * point.opening), along(&|point| point.opening.powi(2)))
            else {
                return shown;
            };
            let slope = |product: f64, square: f64| if square > 0.0 { product / square } else { 0.0 };
            let slopes: Vec<f64> = product.iter().zip(&square).map(|(p, q)| slope(p.mean, q.mean)).collect();
            let least = LEAST_SLOPE * slopes.iter().map(|slope| slope.abs()).fold(0.0, f64::max);
            let bins = shown.bins.iter().zip(&slopes).filter(|(_, slope)| slope.abs() > least).map(|(bin, slope)| {
                ContributionBin {
                    at: bin.at,
                    nominal: bin.at,
                    lacking: bin.lacking / slope,
                    standard_error: bin.standard_error / slope.abs(),
                    effect: bin.effect / slope,
                }
            });
            let bins: Vec<ContributionBin> = bins.collect();
            if bins.len() < LEAST_BINS { shown } else { Contribution { bins, drawn, unit: "m2", ..shown } }
        }
    }
}

/// The equation in which the effect is largest, in units of noise. For an effect that shifts an opening it is a chamber's
/// equation, because there the flow of each edge appears alone.
fn clearest_equation(pairs: &[(Point, f64)], addition: &Addition) -> Option<EquationKind> {
    let mut sums: BTreeMap<EquationKind, f64> = BTreeMap::new();
    for (point, effect) in pairs.iter().filter(|(point, _)| point.residual != 0.0) {
        *sums.entry(point.kind).or_default() += (point.weighed / point.residual * effect).powi(2);
    }
    let mut sums: Vec<(EquationKind, f64)> = sums.into_iter().filter(|(_, sum)| *sum > 0.0).collect();
    sums.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let of_a_chamber =
        |kind: &EquationKind| matches!(kind, EquationKind::CapContinuity(_) | EquationKind::RodContinuity(_));
    let chamber = sums.iter().map(|(kind, _)| *kind).find(of_a_chamber).filter(|_| shifts_an_opening(addition));
    chamber.or(sums.first().map(|(kind, _)| *kind))
}

/// Whether the effect acts on the valve's opening, and not on an instrument.
fn shifts_an_opening(addition: &Addition) -> bool {
    !addition.physics.has_power() && addition.physics.card().acts_on != ActsOn::Instruments
}

/// Bins along the variable that explains most of the effect, or along the command if the effect shifts an opening and the command
/// explains enough.
fn along_its_variable(
    kind: EquationKind,
    pairs: &[(Point, f64)],
    model: &Model,
    prefers_command: bool,
) -> Option<Contribution> {
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
        .max_by(|a, b| {
            let rank =
                |own: &(f64, &str, Vec<Bin>, Variable)| prefers_command && own.1 == "command" && own.0 >= LEAST_SHARE;
            rank(a).cmp(&rank(b)).then(a.0.total_cmp(&b.0))
        })?;
    let lacking = along(of, &|pair| pair.0.residual)?;
    (share >= LEAST_SHARE).then(|| Contribution {
        equation: kind.name(model),
        variable,
        drawn: Drawn::Residual,
        unit: unit_of(kind, model),
        share,
        bins: lacking
            .iter()
            .zip(&effect)
            .map(|(lacking, effect)| ContributionBin {
                at: lacking.at,
                nominal: 0.0,
                lacking: lacking.mean,
                standard_error: lacking.standard_error(),
                effect: effect.mean,
            })
            .collect(),
    })
}
