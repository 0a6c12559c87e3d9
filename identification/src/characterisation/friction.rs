//! Friction against speed: \[B\] Eq. 16.

use excavator_model::Model;
use excavator_model::recording::Recording;
use nalgebra::{DMatrix, DVector};

use super::estimate::Estimate;
use super::load::load_force;
use super::polynomial::f_ratio;
use super::refusal::Refusal;
use super::stretches::{LEAST_STEADY, SETTLING, different, steady};
use super::track::Track;

/// Stretches needed, and the number of different speeds in one direction.
const NEEDED: (usize, usize) = (6, 3);
/// Fastest over slowest speed needed in one direction.
const NEEDED_RATIO: f64 = 2.0;
/// Speeds closer to each other than this share of the fastest count as the same.
const SAME_SPEED: f64 = 0.03;
/// Significance: a term is accepted if chance would bring such an improvement with less than this probability.
const SIGNIFICANCE: f64 = 0.01;
/// Iterations of the search for the Stribeck speed; each is a linear fit.
const POLISHING: usize = 8;
/// Smallest load, N, whose share can be fitted.
const LEAST_LOAD: f64 = 1.0;
/// Smallest and largest Stribeck speed that is tried, m/s.
const STRIBECK_SPEEDS: (f64, f64) = (3e-3, 0.1);
/// Steps between them: neighbouring trial speeds differ by 6 %.
const STRIBECK_TRIALS: i32 = 60;

/// One steady stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForcePoint {
    /// Piston speed, m/s.
    pub speed: f64,
    /// Friction force after subtraction of the load, N.
    pub force: f64,
}

/// A term of the friction curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionTerm {
    /// Effect of the catalogue with this term.
    pub effect: &'static str,
    /// What the coefficient multiplies.
    pub shape: &'static str,
    /// Coefficient.
    pub coefficient: Estimate,
    /// Unit of the coefficient.
    pub unit: &'static str,
}

/// Friction against speed.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionCurve {
    /// Whether a load cell measured the load. Otherwise the load is that of the model, times a fitted share.
    pub from_load_cell: bool,
    /// Ratio of load to the model's load, if no load cell measured it.
    pub load_share: Option<Estimate>,
    /// Coulomb and viscous friction, and other terms that are significant.
    pub terms: Vec<FrictionTerm>,
    /// Speed at which Stribeck friction has fallen to 37 %, m/s, if that term is significant.
    pub stribeck_speed: Option<Estimate>,
    /// Root mean square distance of the points from the curve, N.
    pub scatter: f64,
    /// Why these terms.
    pub reason: String,
    /// Stretches, in order of speed.
    pub points: Vec<ForcePoint>,
    covariance: DMatrix<f64>,
}

impl FrictionCurve {
    /// Coefficient of an effect's term; `None` if the curve does not have it.
    pub fn coefficient(&self, effect: &str) -> Option<Estimate> {
        self.terms.iter().find(|term| term.effect == effect).map(|term| term.coefficient)
    }

    /// Friction at a speed (m/s) with its standard error, N.
    pub fn at(&self, speed: f64) -> Estimate {
        let stribeck = self.stribeck_speed.map(|faded| Stribeck {
            speed: faded.value,
            force: self.coefficient("stribeck_friction").map(|force| force.value),
        });
        let columns = Terms { hose: self.has("hose_loss"), stribeck }.columns(speed);
        let offset = usize::from(self.load_share.is_some());
        let shape =
            DVector::from_fn(columns.len() + offset, |row, _| if row < offset { 0.0 } else { columns[row - offset] });
        let value = columns.iter().zip(&self.terms).map(|(column, term)| column * term.coefficient.value).sum();
        Estimate { value, error: shape.dot(&(&self.covariance * &shape)).max(0.0).sqrt() }
    }

    fn has(&self, effect: &str) -> bool {
        self.terms.iter().any(|term| term.effect == effect)
    }
}

/// Terms of a curve beyond Coulomb and viscous friction.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Terms {
    hose: bool,
    stribeck: Option<Stribeck>,
}

/// Stribeck friction that fades by `speed` (m/s). With a `force` (N) the speed is an unknown too, and an additional column holds
/// the derivative of the curve with respect to it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stribeck {
    speed: f64,
    force: Option<f64>,
}

impl Terms {
    fn columns(self, speed: f64) -> Vec<f64> {
        let sign = speed.signum();
        let mut columns = vec![sign, speed];
        if self.hose {
            columns.push(speed * speed.abs());
        }
        if let Some(stribeck) = self.stribeck {
            let shape = (-(speed / stribeck.speed).powi(2)).exp() * sign;
            columns.push(shape);
            columns.extend(stribeck.force.map(|force| force * shape * 2.0 * speed * speed / stribeck.speed.powi(3)));
        }
        columns
    }

    /// Number of unknowns, including the Stribeck speed.
    fn count(self) -> usize {
        2 + usize::from(self.hose) + 2 * usize::from(self.stribeck.is_some())
    }
}

struct Sample {
    speed: f64,
    /// Pressure force, less the load that a load cell measured.
    force: f64,
    /// The model's load; zero with a load cell.
    load: f64,
}

struct Fitted {
    values: DVector<f64>,
    covariance: DMatrix<f64>,
    squares: f64,
    terms: Terms,
}

/// Friction against speed from steady stretches.
///
/// Eq. 16, `f = A1 P1 - A2 P2 - L`: the rod force of a recording is positive when it pushes the rod out, so L is its negative.
/// Without a load cell, the load is the force that the model's inertia and gravity need for the motion, times a share that is
/// fitted together with friction; motion in both directions separates the two. The quadratic term of the paper is the loss in
/// hoses, `v |v|` here. Quadratic and Stribeck terms are included only if they reduce the squared error with a significance of
/// 1 % (F test) and have the sign of a loss.
///
/// # Errors
/// [`Refusal`].
pub fn friction(
    model: &Model,
    cylinder: usize,
    recordings: &[&Recording],
    tracks: &[Track],
) -> Result<FrictionCurve, Refusal> {
    let from_load_cell = tracks.iter().any(|track| !track.rod_force.is_empty());
    let mut samples = Vec::new();
    for (track, recording) in tracks.iter().zip(recordings) {
        for stretch in steady(track) {
            let [cap, rod, ..] = stretch.pressures;
            let pushed = track.areas.0 * cap - track.areas.1 * rod;
            let (force, load) = match (from_load_cell, stretch.rod_force) {
                (true, Some(rod_force)) => (pushed + rod_force, 0.0),
                (true, None) => continue,
                (false, _) => (pushed, load_force(model, cylinder, recording, &stretch)),
            };
            if force.is_finite() && load.is_finite() {
                samples.push(Sample { speed: stretch.speed.value, force, load });
            }
        }
    }
    let time_scale = tracks.first().map_or(1.0, |track| track.size.time());
    check(&samples, from_load_cell, time_scale)?;
    let alike = || Refusal::SpeedsTooAlike { found: samples.len() };
    // A level drive without weight has practically no load, so no share can be fitted.
    let with_load = samples.iter().any(|sample| sample.load.abs() > LEAST_LOAD);
    let mut best = fit(&samples, with_load, Terms { hose: false, stribeck: None }).ok_or_else(alike)?;
    let mut reasons = Vec::new();
    for _ in 0..2 {
        let mut tried: Vec<Fitted> = Vec::new();
        if !best.terms.hose {
            let with_hose = fit(&samples, with_load, Terms { hose: true, ..best.terms });
            tried.extend(with_hose.map(|one| polished(&samples, with_load, one)));
        }
        if best.terms.stribeck.is_none() {
            let (slowest, fastest) = STRIBECK_SPEEDS;
            let faded = |trial: i32| slowest * (fastest / slowest).powf(f64::from(trial) / f64::from(STRIBECK_TRIALS));
            let stribeck = |trial: i32| Stribeck { speed: faded(trial), force: None };
            let speeds = (0..=STRIBECK_TRIALS).map(|trial| Terms { stribeck: Some(stribeck(trial)), ..best.terms });
            let fits = speeds.filter_map(|terms| fit(&samples, with_load, terms));
            tried.extend(
                fits.min_by(|a, b| a.squares.total_cmp(&b.squares)).map(|one| polished(&samples, with_load, one)),
            );
        }
        let judged = tried.into_iter().filter_map(|fitted| {
            let added = fitted.terms.count() - best.terms.count();
            let offset = usize::from(with_load);
            let freedom = samples.len().checked_sub(fitted.terms.count() + offset).filter(|&left| left > 0)?;
            let (ratio, probability) = f_ratio(best.squares - fitted.squares, fitted.squares, added, freedom)?;
            Some((fitted, ratio, probability))
        });
        let mut judged: Vec<(Fitted, f64, f64)> = judged.collect();
        judged.sort_by(|a, b| a.2.total_cmp(&b.2));
        let position = judged.iter().position(|(fitted, _, p)| *p < SIGNIFICANCE && is_loss(fitted, with_load));
        let told = |(fitted, ratio, probability): &(Fitted, f64, f64), word: &str| {
            let name = if fitted.terms.hose != best.terms.hose { "Quadratic loss" } else { "Stribeck friction" };
            let ratio = if *ratio < 1e3 { format!("F = {ratio:.1}") } else { "F > 1000".to_string() };
            format!("{name} {word} ({ratio}, p = {probability:.2})")
        };
        match position {
            Some(position) => {
                reasons.push(told(&judged[position], "shows"));
                best = judged.swap_remove(position).0;
            }
            None => {
                reasons.extend(judged.iter().map(|one| told(one, "does not show")));
                break;
            }
        }
    }
    Ok(curve(&samples, from_load_cell, with_load, best, reasons.join("; ")))
}

/// Checks that there are enough speeds; `time_scale` is the cylinder's unit of time relative to the reference.
fn check(samples: &[Sample], from_load_cell: bool, time_scale: f64) -> Result<(), Refusal> {
    // Each direction separately: a load cell offset, or friction that depends on direction, must not look like a slope.
    let of = |sign: f64| -> Vec<f64> {
        samples.iter().map(|sample| sign * sample.speed).filter(|&speed| speed > 0.0).collect()
    };
    let (extending, retracting) = (of(1.0), of(-1.0));
    let span = |speeds: &[f64]| {
        let (slowest, fastest) =
            speeds.iter().fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), &v| (low.min(v), high.max(v)));
        (different(speeds.iter().copied(), SAME_SPEED * fastest), if fastest > 0.0 { fastest / slowest } else { 1.0 })
    };
    let (one, other) = (span(&extending), span(&retracting));
    let (speeds, ratio) = (one.0.max(other.0), one.1.max(other.1));
    let one_way = !from_load_cell && (extending.is_empty() || retracting.is_empty());
    if samples.len() >= NEEDED.0 && speeds >= NEEDED.1 && ratio >= NEEDED_RATIO && !one_way {
        return Ok(());
    }
    Err(Refusal::TooFewSpeeds {
        found: samples.len(),
        extending: extending.len(),
        retracting: retracting.len(),
        speeds,
        ratio,
        needed: NEEDED.0,
        needed_speeds: NEEDED.1,
        needed_ratio: NEEDED_RATIO,
        both: if from_load_cell { "" } else { ", and both directions, as no load cell tells friction from load" },
        least: LEAST_STEADY * time_scale,
        settling: SETTLING * time_scale,
    })
}

fn fit(samples: &[Sample], with_load: bool, terms: Terms) -> Option<Fitted> {
    let offset = usize::from(with_load);
    let rows: Vec<Vec<f64>> = samples.iter().map(|sample| terms.columns(sample.speed)).collect();
    let columns = rows.first()?.len() + offset;
    let freedom = samples.len().checked_sub(columns).filter(|&left| left > 0)?;
    let matrix = DMatrix::from_fn(samples.len(), columns, |row, column| {
        if column < offset { samples[row].load } else { rows[row][column - offset] }
    });
    let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
    if lengths.iter().any(|&length| length <= 0.0) {
        return None;
    }
    let scaled = DMatrix::from_fn(samples.len(), columns, |row, column| matrix[(row, column)] / lengths[column]);
    let decomposed = scaled.clone().svd(true, true);
    if decomposed.singular_values.min() < 1e-6 * decomposed.singular_values.max() {
        return None;
    }
    let right = DVector::from_iterator(samples.len(), samples.iter().map(|sample| sample.force));
    let inverse = (scaled.transpose() * &scaled).try_inverse()?;
    let solved = &inverse * (scaled.transpose() * &right);
    let squares = (&right - &scaled * &solved).norm_squared();
    let values = DVector::from_fn(columns, |row, _| solved[row] / lengths[row]);
    let variance = squares / freedom as f64;
    let covariance = DMatrix::from_fn(columns, columns, |row, column| {
        variance * inverse[(row, column)] / (lengths[row] * lengths[column])
    });
    Some(Fitted { values, covariance, squares, terms })
}

/// Refines a fit with the Stribeck speed as an additional unknown: Gauss-Newton from the start values. Returns the start if that
/// does not improve the fit.
fn polished(samples: &[Sample], with_load: bool, start: Fitted) -> Fitted {
    let Some(first) = start.terms.stribeck else { return start };
    let at = 2 + usize::from(start.terms.hose) + usize::from(with_load);
    let (mut speed, mut force) = (first.speed, start.values[at]);
    let mut best = None;
    for _ in 0..POLISHING {
        let terms = Terms { stribeck: Some(Stribeck { speed, force: Some(force) }), ..start.terms };
        let Some(fitted) = fit(samples, with_load, terms) else { break };
        (force, speed) = (fitted.values[at], (speed + fitted.values[at + 1]).clamp(0.7 * speed, 1.4 * speed));
        best = Some(fitted);
    }
    best.filter(|fitted| fitted.squares <= start.squares).unwrap_or(start)
}

/// Whether the terms beyond Coulomb and viscous friction dissipate energy.
fn is_loss(fitted: &Fitted, with_load: bool) -> bool {
    let first = 2 + usize::from(with_load);
    let losses = usize::from(fitted.terms.hose) + usize::from(fitted.terms.stribeck.is_some());
    fitted.values.iter().skip(first).take(losses).all(|&coefficient| coefficient > 0.0)
}

fn curve(samples: &[Sample], from_load_cell: bool, with_load: bool, fitted: Fitted, reason: String) -> FrictionCurve {
    let offset = usize::from(with_load);
    let estimate = |at: usize| Estimate { value: fitted.values[at], error: fitted.covariance[(at, at)].sqrt() };
    let load_share = with_load.then(|| estimate(0));
    let mut cards = vec![("coulomb_friction", "sgn v", "N"), ("viscous_damping", "v", "N s/m")];
    if fitted.terms.hose {
        cards.push(("hose_loss", "v |v|", "N s2/m2"));
    }
    if fitted.terms.stribeck.is_some() {
        cards.push(("stribeck_friction", "exp(-(v/vs)^2) sgn v", "N"));
    }
    let terms = cards.into_iter().enumerate().map(|(number, (effect, shape, unit))| FrictionTerm {
        effect,
        shape,
        coefficient: estimate(offset + number),
        unit,
    });
    let share = load_share.map_or(0.0, |share: Estimate| share.value);
    let mut points: Vec<ForcePoint> = samples
        .iter()
        .map(|sample| ForcePoint { speed: sample.speed, force: sample.force - share * sample.load })
        .collect();
    points.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    let freedom = (samples.len() - fitted.values.len()) as f64;
    FrictionCurve {
        from_load_cell,
        load_share,
        terms: terms.collect(),
        stribeck_speed: fitted.terms.stribeck.map(|stribeck| {
            let last = fitted.values.len() - 1;
            let error = if stribeck.force.is_some() { fitted.covariance[(last, last)].sqrt() } else { f64::NAN };
            Estimate { value: stribeck.speed, error }
        }),
        scatter: (fitted.squares / freedom).sqrt(),
        reason,
        points,
        covariance: fitted.covariance,
    }
}
