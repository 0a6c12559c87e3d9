//! Gains of the metering edges from steady stretches: \[B\] Eq. 7-11.

use excavator_model::equations::smooth::{LAMINAR_PRESSURE, orifice_root};

use super::dead_zone::{DeadZone, LEAST_DROP};
use super::edge::Edge;
use super::estimate::Estimate;
use super::polynomial::{Point, Polynomial};
use super::refusal::Refusal;
use super::stretches::{LEAST_STEADY, SETTLING, Steady, different, length, steady, still};
use super::track::Track;

/// Stretches needed at an edge, and the number of different openings.
const NEEDED: (usize, usize) = (5, 4);
/// Openings closer to each other than this share of the largest count as the same.
const SAME_OPENING: f64 = 0.02;
/// Highest degree of a polynomial.
const HIGHEST_DEGREE: usize = 4;
/// Relative uncertainty of a gain besides noise, because speed and pressures of a stretch are not exactly steady.
const UNSTEADY: f64 = 1e-3;

/// One steady stretch at one edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GainPoint {
    /// Magnitude of the opening, m².
    pub opening: f64,
    /// Piston speed, m/s.
    pub speed: f64,
    /// Flow through the edge, m³/s.
    pub flow: f64,
    /// Pressure drop over the edge, Pa.
    pub pressure_drop: f64,
    /// Flow over opening and root of the pressure drop, m/(s sqrt(Pa)): k of Eq. 11 with the area law of this project.
    pub gain: Estimate,
    /// The same with the opening counted from the edge of the dead zone, if that is known; the error includes that of the edge.
    pub gain_past_edge: Option<Estimate>,
}

/// Gain of one metering edge.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectionalGain {
    /// Stretches, in order of opening.
    pub points: Vec<GainPoint>,
    /// k over x = |u|/umax, as in the paper; the dead zone bends it.
    pub polynomial: Polynomial,
    /// Gain over x with the opening counted from the edge; `None` if the dead zone is unknown.
    pub past_edge: Option<Polynomial>,
    /// Largest opening umax, m².
    pub maximum: f64,
}

/// Gain of each edge as a function of the opening.
///
/// `k = A v / (|u| sqrt(drop))`: Eq. 11 with the area law `u` in place of alpha, which is singular at |xv| = 1. The flow is that
/// of the piston, corrected for known leakage and for the oil that a slow change of pressure compresses; Eq. 10 neglects both.
pub fn directional_gains(
    tracks: &[Track],
    dead_zones: &[(Edge, Result<DeadZone, Refusal>)],
) -> Vec<(Edge, Result<DirectionalGain, Refusal>)> {
    let stretches: Vec<(usize, Vec<Steady>)> =
        tracks.iter().enumerate().map(|(number, track)| (number, steady(track))).collect();
    let begins = |edge: Edge| {
        let own = dead_zones.iter().find(|(other, _)| *other == edge).and_then(|(_, found)| found.as_ref().ok());
        own.map(|found| found.opening)
    };
    Edge::ALL.iter().map(|&edge| (edge, gain(tracks, &stretches, edge, begins(edge)))).collect()
}

fn gain(
    tracks: &[Track],
    stretches: &[(usize, Vec<Steady>)],
    edge: Edge,
    begins: Option<Estimate>,
) -> Result<DirectionalGain, Refusal> {
    let maximum = tracks.first().map_or(0.0, Track::maximum_opening);
    if maximum <= 0.0 {
        let cylinder = tracks.first().map_or(String::new(), |track| track.cylinder.clone());
        return Err(Refusal::NoValve { cylinder });
    }
    let sign = edge.direction.sign();
    let mut points: Vec<GainPoint> = stretches
        .iter()
        .flat_map(|(number, own)| own.iter().map(|stretch| (&tracks[*number], stretch)))
        .filter(|(_, stretch)| sign * stretch.opening.value > SAME_OPENING * maximum)
        .filter_map(|(track, stretch)| point(track, stretch, edge, begins))
        .collect();
    points.sort_by(|a, b| a.opening.total_cmp(&b.opening));
    let openings = different(points.iter().map(|point| point.opening), SAME_OPENING * maximum);
    let time_scale = tracks.first().map_or(1.0, |track| track.size.time());
    let refused = || Refusal::TooFewSteadyStretches {
        found: points.len(),
        openings,
        needed: NEEDED.0,
        needed_openings: NEEDED.1,
        longest: tracks.iter().map(|track| longest(track, sign)).fold(0.0, f64::max),
        least: LEAST_STEADY * time_scale,
        settling: SETTLING * time_scale,
    };
    if points.len() < NEEDED.0 || openings < NEEDED.1 {
        return Err(refused());
    }
    let highest = HIGHEST_DEGREE.min(openings - 2);
    let over = |of: &dyn Fn(&GainPoint) -> Option<Estimate>| -> Vec<Point> {
        let found = points.iter().filter_map(|point| Some((point.opening / maximum, of(point)?)));
        found.map(|(x, gain)| Point { x, y: gain.value, error: gain.error.hypot(UNSTEADY * gain.value) }).collect()
    };
    let polynomial = Polynomial::through(&over(&|point| Some(point.gain)), highest).ok_or_else(refused)?;
    let past_edge = begins.and_then(|begins| {
        let mut curve = Polynomial::through(&over(&|point| point.gain_past_edge), highest)?;
        // All points share the error of the edge position.
        let shifted = Estimate { value: begins.value + begins.error, ..begins };
        let moved = |point: &GainPoint| {
            let past = point.opening - shifted.value;
            let gain = point.gain.value * point.opening / past;
            (past > 0.0).then_some(Estimate { value: gain, error: point.gain_past_edge?.error })
        };
        curve.widen(&Polynomial::of_degree(&over(&moved), curve.degree())?);
        Some(curve)
    });
    Ok(DirectionalGain { points, polynomial, past_edge, maximum })
}

fn point(track: &Track, stretch: &Steady, edge: Edge, begins: Option<Estimate>) -> Option<GainPoint> {
    let (flow, drop) = stretch.through(edge, track.areas);
    if drop < LEAST_DROP || !flow.value.is_finite() {
        return None;
    }
    let root = orifice_root(drop, LAMINAR_PRESSURE);
    let opening = stretch.opening.value.abs();
    let gain_from = |open: f64| {
        let value = flow.value / (open * root);
        let relative = (flow.error / flow.value).hypot(stretch.opening.error / open);
        Estimate { value, error: (value * relative).abs() }
    };
    let gain_past_edge = begins.filter(|begins| opening - begins.value > 0.1 * opening).map(|begins| {
        let past = opening - begins.value;
        let gain = gain_from(past);
        Estimate { error: gain.error.hypot(gain.value * begins.error / past), ..gain }
    });
    Some(GainPoint {
        opening,
        speed: stretch.speed.value,
        flow: flow.value,
        pressure_drop: drop,
        gain: gain_from(opening),
        gain_past_edge,
    })
}

/// Longest time at constant opening on one side, s.
fn longest(track: &Track, sign: f64) -> f64 {
    let least = SAME_OPENING * track.maximum_opening();
    let open = |run: &super::stretches::Still| sign * track.smooth_opening[(run.first + run.last) / 2] > least;
    still(track).into_iter().filter(open).map(|run| length(track, run)).fold(0.0, f64::max)
}
