//! Dead zone and hysteresis of the valve from flow over root of the pressure drop: \[B\] IV-B.

use excavator_model::equations::smooth::{LAMINAR_PRESSURE, orifice_root};

use super::edge::Edge;
use super::estimate::Estimate;
use super::polynomial::{Point, Polynomial};
use super::refusal::Refusal;
use super::sweeps::{HIGH, LOW, SLOWEST, Sweep, fastest, sweeps};
use super::track::Track;

/// Pressure drop below which flow over its root is not informative, Pa: fifty times the laminar transition of an orifice.
pub(super) const LEAST_DROP: f64 = 1e5;
/// Runs of each kind needed.
const NEEDED: usize = 2;
/// Fitted part of the way from the edge to the largest opening of the run. Near the turning point an opening with play does not
/// move.
const FITTED: f64 = 0.6;
/// Standard errors below zero beyond which a hysteresis is rejected: noise is so far off in one of 700 tests.
const LEADS: f64 = 3.0;
/// Runs of each kind that are shown.
const SHOWN: usize = 6;
/// Fewest samples of a fit.
const FEWEST: usize = 15;

/// Normalised flow against opening in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeCurve {
    /// Whether the valve opened.
    pub opens: bool,
    /// Opening (m²) and flow over root of the pressure drop (m³/(s sqrt(Pa))), thinned.
    pub points: Vec<(f64, f64)>,
}

/// Where flow through a metering edge begins and ends. Openings are magnitudes, m².
#[derive(Debug, Clone, PartialEq)]
pub struct DeadZone {
    /// Opening at which flow begins while the valve opens.
    pub opening: Estimate,
    /// Opening at which it ends while the valve closes.
    pub closing: Estimate,
    /// Dead zone: the mean of both.
    pub dead_zone: Estimate,
    /// Hysteresis: opening less closing, at least zero; the width of the play.
    pub hysteresis: Estimate,
    /// Rate of the opening at the edge, m²/s: a lag of `hysteresis / (2 rate)` would look the same.
    pub rate: f64,
    /// Number of opening and of closing runs.
    pub runs: (usize, usize),
    /// Some of the curves, for the page.
    pub curves: Vec<EdgeCurve>,
}

impl DeadZone {
    /// The lag from measured to effective opening (s) that would look like the whole hysteresis.
    pub fn lag_that_looks_the_same(&self) -> f64 {
        self.hysteresis.value / (2.0 * self.rate)
    }
}

/// One run at one edge.
struct Run {
    /// Where the edge is, with its error from noise.
    edge: Estimate,
    /// Rate of the opening at the edge, m²/s.
    rate: f64,
    /// Half of what the opening changes in a sample interval, m². The edge cannot be located better between two samples.
    step: f64,
    curve: EdgeCurve,
}

impl Run {
    fn error(&self) -> f64 {
        self.edge.error.hypot(self.step)
    }
}

/// Mean of the runs' edges and the matching rate. Slow runs have the largest weight. The error of half a sample interval is
/// common to all runs, so it does not fall with their number.
fn mean_edge(runs: &[Run]) -> Option<(Estimate, f64)> {
    let edges: Vec<Estimate> = runs.iter().map(|run| Estimate { value: run.edge.value, error: run.error() }).collect();
    let mean = Estimate::mean(&edges)?;
    let weights: f64 = runs.iter().map(|run| run.error().powi(-2)).sum();
    let weighted = |of: fn(&Run) -> f64| runs.iter().map(|run| of(run) * run.error().powi(-2)).sum::<f64>() / weights;
    Some((Estimate { error: mean.error.hypot(weighted(|run| run.step)), ..mean }, weighted(|run| run.rate)))
}

/// Dead zone and hysteresis of each edge.
///
/// In every run of the valve through an edge, `flow / sqrt(drop)` against opening is a line or a slightly bent curve that begins
/// at the edge; its root is the edge. The paper neglects compressibility and leakage and computes the flow from the piston's
/// speed alone. Near the edge both are as large as the flow, so here the measured pressures give the compressed oil, and known
/// leakage is subtracted.
pub fn dead_zones(tracks: &[Track]) -> Vec<(Edge, Result<DeadZone, Refusal>)> {
    Edge::ALL.iter().map(|&edge| (edge, dead_zone(tracks, edge))).collect()
}

fn dead_zone(tracks: &[Track], edge: Edge) -> Result<DeadZone, Refusal> {
    let Some(track) = tracks.first().filter(|track| track.maximum_opening() > 0.0) else {
        let cylinder = tracks.first().map_or(String::new(), |track| track.cylinder.clone());
        return Err(Refusal::NoValve { cylinder });
    };
    let (mut opening, mut closing, mut curves): (Vec<Run>, Vec<Run>, Vec<EdgeCurve>) = Default::default();
    for track in tracks {
        for sweep in sweeps(track, edge.direction) {
            let Some(mut run) = run(track, edge, sweep) else { continue };
            if curves.iter().filter(|curve| curve.opens == sweep.opens).count() < SHOWN {
                curves.push(std::mem::replace(&mut run.curve, EdgeCurve { opens: sweep.opens, points: Vec::new() }));
            }
            (if sweep.opens { &mut opening } else { &mut closing }).push(run);
        }
    }
    let refused = || Refusal::TooFewSweeps {
        found_opening: opening.len(),
        found_closing: closing.len(),
        needed: NEEDED,
        low: 100.0 * LOW,
        high: 100.0 * HIGH,
        slowest: SLOWEST,
        fastest: fastest(track),
    };
    if opening.len() < NEEDED || closing.len() < NEEDED {
        return Err(refused());
    }
    let (Some((begins, opening_rate)), Some((ends, closing_rate))) = (mean_edge(&opening), mean_edge(&closing)) else {
        return Err(refused());
    };
    let both = begins.error.hypot(ends.error);
    if begins.value - ends.value < -LEADS * both {
        let full = track.maximum_opening();
        return Err(Refusal::FlowLeads { begins: begins.value / full, ends: ends.value / full });
    }
    Ok(DeadZone {
        opening: begins,
        closing: ends,
        dead_zone: Estimate { value: 0.5 * (begins.value + ends.value), error: 0.5 * both },
        // Play has no negative width; a negative value is noise.
        hysteresis: Estimate { value: (begins.value - ends.value).max(0.0), error: both },
        rate: 0.5 * (opening_rate + closing_rate),
        runs: (opening.len(), closing.len()),
        curves,
    })
}

/// The edge in one run. The first estimate comes from a line through the middle of the flow. Three refinements fit a curve to the
/// part behind the edge that smoothing does not affect.
fn run(track: &Track, edge: Edge, sweep: Sweep) -> Option<Run> {
    let sign = edge.direction.sign();
    let samples: Vec<(f64, f64, f64)> = (sweep.first..=sweep.last)
        .filter_map(|index| {
            let (flow, drop) = track.through(edge, index);
            let normalised = flow / orifice_root(drop, LAMINAR_PRESSURE);
            let usable = drop > LEAST_DROP && normalised.is_finite();
            usable.then(|| (sign * track.smooth_opening[index], normalised, track.opening_rate[index].abs()))
        })
        .collect();
    let most = samples.iter().map(|sample| sample.1).fold(0.0, f64::max);
    let widest = samples.iter().map(|sample| sample.0).fold(0.0, f64::max);
    let middle: Vec<Point> = samples
        .iter()
        .filter(|(_, flow, _)| (0.15 * most..0.6 * most).contains(flow))
        .map(|&(x, y, _)| Point { x, y, error: 1.0 })
        .collect();
    let line = (middle.len() >= FEWEST).then(|| Polynomial::of_degree(&middle, 1)).flatten()?;
    let mut root = -line.coefficients[0] / line.coefficients[1];
    let mut error = f64::INFINITY;
    for _ in 0..3 {
        let rate = rate_at(&samples, root)?;
        let begin = root + 1.5 * track.half_width * rate;
        let end = root + FITTED * (widest - root);
        let behind: Vec<Point> = samples
            .iter()
            .filter(|(x, ..)| (begin..end).contains(x))
            .map(|&(x, y, _)| Point { x: x - root, y, error: 1.0 })
            .collect();
        if behind.len() < FEWEST {
            return None;
        }
        let noise = scatter(&behind)?;
        let weighed: Vec<Point> = behind.into_iter().map(|point| Point { error: noise, ..point }).collect();
        let curve = Polynomial::through(&weighed, 2).filter(|curve| curve.degree() > 0)?;
        let slope = curve.coefficients[1];
        if slope <= 0.0 {
            return None;
        }
        root -= curve.coefficients[0] / slope;
        // Flows within one smoothing parabola share their noise.
        let alike = (2.0 * track.half_width / interval(track, sweep)).max(1.0);
        error = curve.error_at(0.0) / slope * alike.sqrt();
    }
    let rate = rate_at(&samples, root)?;
    let stride = samples.len().div_ceil(120).max(1);
    let points = samples.iter().step_by(stride).map(|&(x, y, _)| (sign * x, y)).collect();
    let inside = root.abs() < widest && error.is_finite();
    let curve = EdgeCurve { opens: sweep.opens, points };
    let step = 0.5 * rate * interval(track, sweep);
    inside.then_some(Run { edge: Estimate { value: root, error }, rate, step, curve })
}

/// Rate of the opening where it is nearest to `opening`.
fn rate_at(samples: &[(f64, f64, f64)], opening: f64) -> Option<f64> {
    let nearest = samples.iter().min_by(|a, b| (a.0 - opening).abs().total_cmp(&(b.0 - opening).abs()))?;
    Some(nearest.2)
}

/// Root mean square distance from a fitted parabola.
fn scatter(points: &[Point]) -> Option<f64> {
    let curve = Polynomial::of_degree(points, 2)?;
    let squares: f64 = points.iter().map(|point| (point.y - curve.at(point.x)).powi(2)).sum();
    let noise = (squares / (points.len() - 3) as f64).sqrt();
    (noise > 0.0).then_some(noise)
}

fn interval(track: &Track, sweep: Sweep) -> f64 {
    (track.time[sweep.last] - track.time[sweep.first]) / (sweep.last - sweep.first).max(1) as f64
}
