//! Finds stretches of time in which the valve does not move.

use excavator_model::recording::{median_interval, noise_level};

use super::edge::{Edge, Side};
use super::estimate::Estimate;
use super::track::Track;

/// Rate below which an opening counts as constant, in largest openings per second: a fifth of the slowest ramp of a trapezoid in
/// the paper (0.25 in 0.5 s). Times, lengths and speeds here are for a cylinder of the reference size.
const STILL: f64 = 0.1;
/// Settling time of pressures and speed after a change of the opening, s: three periods of a loaded cylinder's oscillation of
/// 30 Hz, more than any trapezoid with a ramp of 0.5 s needs.
pub(super) const SETTLING: f64 = 0.1;
/// Minimum length of a steady stretch, s. With 0.02 mm of sensor noise its speed is accurate to 0.1 mm/s.
pub(super) const LEAST_STEADY: f64 = 0.15;
/// Longest stretch that is used as one, s. In longer ones the speed may change with position.
const LONGEST_STEADY: f64 = 1.0;
/// Relative change of the speed allowed within a stretch.
const CHANGE: f64 = 0.2;
/// Minimum speed, m/s: five times the speed over which the model rounds the sign of the velocity.
const LEAST_SPEED: f64 = 5e-3;
/// Ratio of the scatter about a parabola to sensor noise above which a piston counts as stick-slipping. The mean force is then
/// not the force at the mean speed.
const JERKY: f64 = 1.3;
/// Scatter allowed without sensor noise, as a share of the distance travelled.
const SHAKE: f64 = 1e-3;
/// Distance kept from the ends of the stroke, m.
const END: f64 = 2e-3;
/// Largest acceleration, m/s², at which a motion without a valve counts as steady.
const EVEN: f64 = 0.5;

/// Samples `first..=last` of a track in which the opening is constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Still {
    pub first: usize,
    pub last: usize,
}

/// A stretch at constant opening and speed: \[B\] Eq. 10.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Steady {
    /// When, s.
    pub time: f64,
    /// Opening, m²; zero without a valve.
    pub opening: Estimate,
    /// Speed in the middle, m/s.
    pub speed: Estimate,
    /// Acceleration, m/s².
    pub acceleration: f64,
    /// Position in the middle, m.
    pub displacement: f64,
    /// Mean pressures of cap side, rod side, pump and tank, Pa.
    pub pressures: [f64; 4],
    /// Mean flows into cap and rod side through the valve, m³/s.
    pub flows: [f64; 2],
    /// Mean force of the load cell on the rod, N.
    pub rod_force: Option<f64>,
    /// First and last sample.
    pub samples: Still,
}

impl Steady {
    /// Flow through an edge (m³/s) with its standard error from the speed, and the pressure drop over it (Pa).
    pub fn through(&self, edge: Edge, areas: (f64, f64)) -> (Estimate, f64) {
        let (flow, pressure, area) = match edge.side {
            Side::Cap => (self.flows[0], self.pressures[0], areas.0),
            Side::Rod => (self.flows[1], self.pressures[1], areas.1),
        };
        let flow = Estimate { value: edge.flow(flow), error: area * self.speed.error };
        (flow, edge.pressure_drop(self.pressures[2], pressure, self.pressures[3]))
    }
}

/// All stretches of constant opening, or of constant speed if there is no valve.
pub(super) fn still(track: &Track) -> Vec<Still> {
    let quiet: Vec<bool> = if track.opening.is_empty() {
        let even = |(velocity, change): (&f64, f64)| change.abs() < CHANGE * velocity.abs();
        let change = velocity_change(track);
        track.velocity.iter().zip(change).map(even).collect()
    } else {
        let limit = STILL / track.size.time() * track.maximum_opening();
        let limit = limit.max(4.0 * rate_noise(track));
        track.opening_rate.iter().map(|rate| rate.abs() < limit).collect()
    };
    let mut found: Vec<Still> = Vec::new();
    for (index, _) in quiet.iter().enumerate().filter(|(_, quiet)| **quiet) {
        match found.last_mut() {
            Some(run) if run.last + 1 == index => run.last = index,
            _ => found.push(Still { first: index, last: index }),
        }
    }
    found
}

/// Change of the speed over half a parabola, m/s.
fn velocity_change(track: &Track) -> Vec<f64> {
    let reach = (track.half_width / median_interval(&track.time)).round().max(1.0) as usize;
    (0..track.time.len())
        .map(|index| {
            let (before, after) = (index.saturating_sub(reach), (index + reach).min(track.time.len() - 1));
            let change = track.velocity[after] - track.velocity[before];
            if change.abs() < EVEN * track.size.speed / track.size.time() * track.half_width {
                change
            } else {
                f64::INFINITY
            }
        })
        .collect()
}

/// Standard error of the opening's rate from the noise of its sensor, m²/s.
fn rate_noise(track: &Track) -> f64 {
    let interval = median_interval(&track.time);
    let reach = (track.half_width / interval).floor();
    let squares = reach * (reach + 1.0) * (2.0 * reach + 1.0) / 3.0;
    noise_level(&track.opening) / (interval * squares.sqrt())
}

/// Length, s.
pub(super) fn length(track: &Track, still: Still) -> f64 {
    track.time[still.last] - track.time[still.first]
}

/// The stretch without its settling time; `None` if nothing remains.
pub(super) fn settled(track: &Track, still: Still) -> Option<Still> {
    let begin = track.time[still.first] + SETTLING * track.size.time();
    let first = still.first + track.time[still.first..=still.last].partition_point(|&t| t < begin);
    (first < still.last).then_some(Still { first, last: still.last })
}

/// Steady stretches of a track, with long ones cut into pieces.
pub(super) fn steady(track: &Track) -> Vec<Steady> {
    let mut found = Vec::new();
    for run in still(track) {
        let Some(whole) = settled(track, run) else { continue };
        let pieces = (length(track, whole) / (LONGEST_STEADY * track.size.time())).ceil().max(1.0);
        let (start, each) = (track.time[whole.first], length(track, whole) / pieces);
        for piece in 0..pieces as usize {
            let (from, to) = (start + each * piece as f64, start + each * (piece + 1) as f64);
            let first = track.time.partition_point(|&t| t < from - 1e-9).max(whole.first);
            let last = track.time.partition_point(|&t| t < to - 1e-9).saturating_sub(1).min(whole.last);
            found.extend(steady_piece(track, Still { first, last }));
        }
    }
    found
}

fn steady_piece(track: &Track, samples: Still) -> Option<Steady> {
    let Still { first, last } = samples;
    if last <= first || length(track, samples) < LEAST_STEADY * track.size.time() {
        return None;
    }
    let range = first..=last;
    let middle = 0.5 * (track.time[first] + track.time[last]);
    let points: Vec<super::polynomial::Point> = range
        .clone()
        .map(|index| super::polynomial::Point {
            x: track.time[index] - middle,
            y: track.displacement[index],
            error: 1.0,
        })
        .filter(|point| point.y.is_finite())
        .collect();
    if points.len() < 8 {
        return None;
    }
    let motion = super::polynomial::Polynomial::of_degree(&points, 2)?;
    let residual = points.iter().map(|point| (point.y - motion.at(point.x)).powi(2)).sum::<f64>();
    let noise = (residual / (points.len() - 3) as f64).sqrt();
    let speed = Estimate { value: motion.coefficients[1], error: noise * motion.covariance[(1, 1)].sqrt() };
    let acceleration = 2.0 * motion.coefficients[2];
    let travel = speed.value.abs() * length(track, samples);
    let even = (acceleration * length(track, samples)).abs() < CHANGE * speed.value.abs()
        && noise < (JERKY * noise_level(&track.displacement[range.clone()])).max(SHAKE * travel);
    let end = END * track.size.stroke;
    let [retracted, extended] = track.ends;
    let free = points.iter().all(|point| point.y > retracted + end && point.y < extended - end);
    if !even || !free || speed.value.abs() < LEAST_SPEED || speed.relative_error() > 0.1 {
        return None;
    }
    let mean = |values: &[f64]| {
        let finite: Vec<f64> = values[range.clone()].iter().copied().filter(|value| value.is_finite()).collect();
        finite.iter().sum::<f64>() / finite.len() as f64
    };
    let displaced = mean(&track.velocity);
    let beyond = |flow: &[f64], area: f64| mean(flow) + area * (speed.value - displaced);
    let opening = if track.opening.is_empty() {
        Estimate { value: 0.0, error: 0.0 }
    } else {
        let value = mean(&track.opening);
        Estimate { value, error: noise_level(&track.opening[range.clone()]) / (points.len() as f64).sqrt() }
    };
    Some(Steady {
        time: middle,
        opening,
        speed,
        acceleration,
        displacement: motion.coefficients[0],
        pressures: [&track.cap_pressure, &track.rod_pressure, &track.pump_pressure, &track.tank_pressure]
            .map(|p| mean(p)),
        flows: [beyond(&track.cap_flow, track.areas.0), beyond(&track.rod_flow, -track.areas.1)],
        rod_force: (!track.rod_force.is_empty()).then(|| mean(&track.rod_force)),
        samples,
    })
}

/// Number of values that differ from each other by more than `step`.
pub(super) fn different(values: impl Iterator<Item = f64>, step: f64) -> usize {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let mut count = 0;
    let mut latest = f64::NEG_INFINITY;
    for value in sorted {
        if value - latest > step {
            count += 1;
            latest = value;
        }
    }
    count
}
