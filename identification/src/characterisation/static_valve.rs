//! Identifies a valve from its static test: flow against input at a known pressure drop on a flow bench.

use excavator_model::recording::noise_level;
use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

use super::Estimate;

/// One reading of a static test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowReading {
    /// Input of the valve, in the unit of the model's command.
    pub input: f64,
    /// Flow over one edge, m³/s; its sign is not used.
    pub flow: f64,
    /// Pressure drop over that edge, Pa.
    pub pressure_drop: f64,
}

/// Result of a static test. `Q = g (|u - n| - z) sqrt(drop)`: flow gain g and dead zone z of each side, null n of both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StaticValve {
    /// Input n at the middle of the closed valve, in its unit: the null bias of ISO 10770-1. Halfway between the inputs at which
    /// both straight lines meet zero flow; of a test with one side, the null that was given.
    pub null: Estimate,
    /// Inputs above the null, and below.
    pub sides: [Option<StaticEdge>; 2],
}

/// One side of the null. The line meets zero flow half the play later while the valve opens, and half the play earlier while it
/// closes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StaticEdge {
    /// Flow gain g per input and root of the pressure drop, m³/(s sqrt(Pa)) per unit of the input.
    pub gain: Estimate,
    /// Input z beyond the null that moves no oil, in its unit; negative for an underlapped spool.
    pub dead_zone: Estimate,
    /// Difference in input between opening and closing, in its unit; `None` if the test runs in one direction only.
    pub play: Option<Estimate>,
    /// Number of readings used.
    pub readings: usize,
}

/// Why a static test says nothing.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StaticTestError {
    /// No side has a straight line.
    #[error(
        "of {readings} readings too few lie on a straight line between 10 % and 90 % of the largest flow, with flow that grows with the input"
    )]
    NoLine {
        /// Number of finite readings.
        readings: usize,
    },
    /// One side only, and nobody says where the valve is closed.
    #[error(
        "the flow has one sign only, so the null cannot be read; the straight line meets zero flow at {crossing:.4} (unit of the model's input): give the input at which the valve is closed"
    )]
    NullUnknown {
        /// Input at which the line meets zero flow, in the unit of the model's input.
        crossing: f64,
    },
}

/// Shares of the largest flow between which the line is fitted. Below, edges leak and overlap is rounded; above, flow forces and
/// channels other than the edge dominate.
const STRAIGHT: [f64; 2] = [0.1, 0.9];

/// Steady stretches are used at any flow: a machine is not driven slowly through all of them, and what is too slow was left out.
const ALL: [f64; 2] = [1e-3, 1.0];

/// Fewest readings for a line.
const FEWEST: usize = 6;

/// Share of the range of inputs by which an input must turn back for a new sweep to begin.
const TURN: f64 = 0.05;

/// Standard deviations of the input's noise by which it must turn back.
const TURN_NOISE: f64 = 10.0;

/// Parts of a sweep whose residuals are taken as independent of each other. Neighbouring readings are not: curvature and drift
/// last for many of them.
const PARTS_OF_A_SWEEP: usize = 4;

/// Gain, null, dead zones and play of a valve. The sign of the flow need not be that of the input: a bench with one flow meter
/// records a flow without a sign. `null` is the input at which the valve is closed, if it is known.
///
/// # Errors
/// [`StaticTestError`].
pub fn static_valve(readings: &[FlowReading], null: Option<f64>) -> Result<StaticValve, StaticTestError> {
    let readings: Vec<FlowReading> =
        readings.iter().filter(|one| one.input.is_finite() && area(one).is_finite()).copied().collect();
    let directions = directions(&readings);
    let signed = signed_areas(&readings, null);
    let lines = [1.0, -1.0].map(|side| Line::of(&readings, &signed, &directions, side, STRAIGHT));
    of_lines(lines, null, readings.len())
}

/// The same of readings that stand for themselves, such as steady stretches of a machine, in no order. Flows have their signs.
///
/// # Errors
/// [`StaticTestError`].
pub(super) fn valve_curve(readings: &[FlowReading]) -> Result<StaticValve, StaticTestError> {
    let each: Vec<(f64, usize)> = (0..readings.len()).map(|index| (0.0, index)).collect();
    let signed: Vec<f64> = readings.iter().map(|one| one.flow.signum() * area(one)).collect();
    let lines = [1.0, -1.0].map(|side| Line::of(readings, &signed, &each, side, ALL));
    of_lines(lines, None, readings.len())
}

fn of_lines(lines: [Option<Line>; 2], null: Option<f64>, readings: usize) -> Result<StaticValve, StaticTestError> {
    let null = match (lines, null) {
        ([None, None], _) => return Err(StaticTestError::NoLine { readings }),
        (_, Some(given)) => Estimate { value: given, error: 0.0 },
        ([Some(above), Some(below)], None) => middle([above.crossing(), below.crossing()]),
        ([Some(line), None], None) => return Err(StaticTestError::NullUnknown { crossing: line.crossing().value }),
        ([None, Some(line)], None) => return Err(StaticTestError::NullUnknown { crossing: -line.crossing().value }),
    };
    let edge = |line: Option<Line>, side: f64| {
        line.map(|line| {
            let crossing = line.crossing();
            StaticEdge {
                gain: line.gain(),
                dead_zone: Estimate { value: crossing.value - side * null.value, ..crossing },
                play: line.play(),
                readings: line.readings,
            }
        })
    };
    let [above, below] = lines;
    Ok(StaticValve { null, sides: [edge(above, 1.0), edge(below, -1.0)] })
}

/// The null, from the inputs at which the lines of both sides meet zero flow, each in the direction of its side.
pub(super) fn middle([above, below]: [Estimate; 2]) -> Estimate {
    Estimate { value: 0.5 * (above.value - below.value), error: 0.5 * above.error.hypot(below.error) }
}

/// Flow over root of the pressure drop.
fn area(one: &FlowReading) -> f64 {
    one.flow.abs() / one.pressure_drop.abs().sqrt()
}

/// [`area`] with the sign of the valve's side. A flow recorded without a sign gets that of the input, counted from the null: the
/// one that is given, or the input of least flow.
fn signed_areas(readings: &[FlowReading], null: Option<f64>) -> Vec<f64> {
    let (least, most) = readings.iter().fold((0.0_f64, 0.0_f64), |(least, most), one| {
        let flow = one.flow.signum() * area(one);
        (least.min(flow), most.max(flow))
    });
    let has_a_sign = least < -STRAIGHT[0] * most && most > -STRAIGHT[0] * least;
    if has_a_sign {
        // A meter may count the flow in the other direction.
        let along: f64 = covariance(readings);
        return readings.iter().map(|one| along.signum() * one.flow.signum() * area(one)).collect();
    }
    let closed = null.or_else(|| {
        let [least, most] = readings
            .iter()
            .map(area)
            .fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], one| [least.min(one), most.max(one)]);
        let nearly = least + 0.5 * STRAIGHT[0] * (most - least);
        let shut: Vec<f64> = readings.iter().filter(|one| area(one) <= nearly).map(|one| one.input).collect();
        (!shut.is_empty()).then(|| shut.iter().sum::<f64>() / shut.len() as f64)
    });
    let closed = closed.unwrap_or(0.0);
    readings.iter().map(|one| (one.input - closed).signum() * area(one)).collect()
}

/// Sign of the covariance tells whether flow grows with the input.
fn covariance(readings: &[FlowReading]) -> f64 {
    let count = readings.len().max(1) as f64;
    let mean = |of: &dyn Fn(&FlowReading) -> f64| readings.iter().map(of).sum::<f64>() / count;
    let (input, flow) = (mean(&|one| one.input), mean(&|one| one.flow));
    readings.iter().map(|one| (one.input - input) * (one.flow - flow)).sum()
}

/// Direction of the input at each reading and the number of its sweep. A sweep ends where the input turns back by more than its
/// noise: neighbouring readings do not tell, since a noisy input rises and falls at every reading.
fn directions(readings: &[FlowReading]) -> Vec<(f64, usize)> {
    let inputs: Vec<f64> = readings.iter().map(|one| one.input).collect();
    let (least, most) = inputs
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &input| (least.min(input), most.max(input)));
    let noise = noise_level(&inputs);
    let turn = (TURN * (most - least)).max(TURN_NOISE * if noise.is_finite() { noise } else { 0.0 });
    // Turning points: the last extreme before the input came back by `turn`.
    let mut turns = vec![0];
    let (mut high, mut low, mut rises) = (0, 0, None);
    for (index, &input) in inputs.iter().enumerate() {
        if input > inputs[high] {
            high = index;
        }
        if input < inputs[low] {
            low = index;
        }
        if rises != Some(false) && inputs[high] - input > turn {
            turns.extend((rises.is_some() || high > 0).then_some(high));
            (rises, low) = (Some(false), index);
        } else if rises != Some(true) && input - inputs[low] > turn {
            turns.extend((rises.is_some() || low > 0).then_some(low));
            (rises, high) = (Some(true), index);
        }
        match rises {
            Some(true) => low = index,
            Some(false) => high = index,
            None => (),
        }
    }
    turns.push(inputs.len().saturating_sub(1));
    turns.dedup();
    let mut found = vec![(0.0, 0); inputs.len()];
    for (sweep, pair) in turns.windows(2).enumerate() {
        let way = (inputs[pair[1]] - inputs[pair[0]]).signum();
        found[pair[0]..=pair[1]].fill((way, sweep));
    }
    found
}

/// The straight part of one side: flow over root of the pressure drop, `g (side u - c) -+ g play/2` while it opens and closes.
#[derive(Debug, Clone, Copy)]
struct Line {
    /// Gain, constant, and gain times play.
    solution: Vector3<f64>,
    covariance: Matrix3<f64>,
    both_ways: bool,
    readings: usize,
}

impl Line {
    /// The line through the readings of one side whose flow is within these shares of the largest.
    fn of(
        readings: &[FlowReading],
        signed: &[f64],
        directions: &[(f64, usize)],
        side: f64,
        straight: [f64; 2],
    ) -> Option<Line> {
        let largest = signed.iter().map(|area| side * area).fold(0.0_f64, f64::max);
        let is_straight = |area: f64| area >= straight[0] * largest && area <= straight[1] * largest;
        let straight: Vec<(Vector3<f64>, f64, usize)> = readings
            .iter()
            .zip(signed)
            .zip(directions)
            .filter(|((_, area), _)| is_straight(side * **area))
            .map(|((one, area), (way, sweep))| {
                (Vector3::new(side * one.input, 1.0, 0.5 * side * way), side * area, *sweep)
            })
            .collect();
        let opening = straight.iter().filter(|(row, ..)| row[2] > 0.0).count();
        let both_ways = opening.min(straight.len() - opening) >= FEWEST / 2;
        let inputs = straight.iter().map(|(row, ..)| row[0]);
        let spread = inputs.clone().fold(f64::NEG_INFINITY, f64::max) - inputs.fold(f64::INFINITY, f64::min);
        // Readings at one input give no slope.
        if straight.len() < FEWEST || largest <= 0.0 || spread <= 0.0 {
            return None;
        }
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for (row, area, _) in &straight {
            let row = if both_ways { *row } else { Vector3::new(row[0], row[1], 0.0) };
            normal += row * row.transpose();
            right += row * *area;
        }
        if !both_ways {
            normal[(2, 2)] = 1.0;
        }
        let inverse = normal.try_inverse()?;
        let solution = inverse * right;
        // Residuals that keep their sign for long count as one each.
        let mut scores: Vec<Vector3<f64>> = Vec::new();
        let mut parts = straight.chunk_by(|one, next| one.2 == next.2);
        for sweep in &mut parts {
            for part in sweep.chunks(sweep.len().div_ceil(PARTS_OF_A_SWEEP)) {
                scores.push(part.iter().map(|(row, area, _)| row * (area - row.dot(&solution))).sum());
            }
        }
        let spread: Matrix3<f64> = scores.iter().map(|score| score * score.transpose()).sum();
        let freedom = scores.len() as f64 / (scores.len() as f64 - 3.0).max(1.0);
        let line =
            Line { solution, covariance: inverse * spread * inverse * freedom, both_ways, readings: straight.len() };
        (solution[0].is_finite() && solution[0] > 0.0).then_some(line)
    }

    fn gain(&self) -> Estimate {
        Estimate { value: self.solution[0], error: self.covariance[(0, 0)].max(0.0).sqrt() }
    }

    /// Input at which the line meets zero flow, in the direction of its side.
    fn crossing(&self) -> Estimate {
        self.over_gain(1)
    }

    fn play(&self) -> Option<Estimate> {
        self.both_ways.then(|| self.over_gain(2))
    }

    /// `-x/g` of a coefficient x, with the errors of both and their covariance.
    fn over_gain(&self, index: usize) -> Estimate {
        let gain = self.solution[0];
        let value = -self.solution[index] / gain;
        let [own, shared, of_gain] = [(index, index), (0, index), (0, 0)].map(|place| self.covariance[place]);
        let variance = own + 2.0 * value * shared + value * value * of_gain;
        Estimate { value, error: variance.max(0.0).sqrt() / gain }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// A sweep from -10 V to 10 V and back.
    fn swept(gain: f64, zones: [f64; 2], play: f64, both_ways: bool) -> Vec<FlowReading> {
        let up = (-100..=100).map(|step| f64::from(step) / 10.0);
        let down = (-100..100).rev().map(|step| f64::from(step) / 10.0);
        let inputs: Vec<(f64, f64)> = up
            .map(|input| (input, 1.0))
            .chain(down.map(|input| (input, -1.0)))
            .take(if both_ways { 401 } else { 201 })
            .collect();
        let drop = 35e5_f64;
        inputs
            .into_iter()
            .enumerate()
            .map(|(number, (input, way))| {
                let spool = input - way * play / 2.0;
                let open = (spool - zones[0]).max(0.0) + (spool + zones[1]).min(0.0);
                // Deterministic noise of one per cent.
                let noise = 1.0 + 0.01 * (2.3 * number as f64).sin();
                FlowReading { input, flow: gain * open * drop.sqrt() * noise, pressure_drop: drop }
            })
            .collect()
    }

    fn both(readings: &[FlowReading]) -> (Estimate, [StaticEdge; 2]) {
        let found = static_valve(readings, None).unwrap();
        (found.null, found.sides.map(Option::unwrap))
    }

    #[test]
    fn gain_null_dead_zone_and_play_are_found() {
        let (null, edges) = both(&swept(2e-8, [0.4, 0.6], 0.3, true));
        assert!((null.value + 0.1).abs() < 0.02, "{null:?}");
        for edge in edges {
            assert!((edge.gain.value / 2e-8 - 1.0).abs() < 0.01, "{edge:?}");
            assert!((edge.dead_zone.value - 0.5).abs() < 0.03, "{edge:?}");
            assert!((edge.play.unwrap().value - 0.3).abs() < 0.03, "{edge:?}");
            assert!((edge.dead_zone.value - 0.5).abs() < 4.0 * edge.dead_zone.error + 1e-3, "{edge:?}");
        }
    }

    #[test]
    fn a_flow_without_a_sign_tells_the_same() {
        let mut readings = swept(2e-8, [0.4, 0.6], 0.3, true);
        let (null, edges) = both(&readings);
        readings.iter_mut().for_each(|one| one.flow = one.flow.abs());
        assert_eq!(both(&readings), (null, edges));
    }

    /// A noisy input rises and falls at every reading. The direction is that of the sweep.
    #[test]
    fn a_noisy_input_has_its_play() {
        let mut generator = 1_u64;
        let mut random = || {
            generator = generator.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (generator >> 33) as f64 / f64::from(u32::MAX >> 1) - 0.5
        };
        let mut readings = Vec::new();
        for (input, way) in (-4000..=4000).map(|step| (step, 1.0)).chain((-4000..4000).rev().map(|step| (step, -1.0))) {
            let input = f64::from(input) / 200.0;
            let flow = 1e-8 * (input - way * 0.225);
            readings.push(FlowReading { input: input + 0.3 * random(), flow, pressure_drop: 1.0 });
        }
        let (_, edges) = both(&readings);
        for play in edges.map(|edge| edge.play.unwrap()) {
            assert!((play.value - 0.45).abs() < 3.0 * play.error && play.error < 0.02, "{play:?}");
        }
    }

    #[test]
    fn one_way_says_nothing_of_a_play() {
        let (_, [positive, negative]) = both(&swept(2e-8, [0.0, 0.0], 0.0, false));
        // From -10 V upwards, the valve closes on the negative side and opens on the positive one.
        assert_eq!((positive.play, negative.play), (None, None));
        assert!(positive.dead_zone.value.abs() < 0.02, "{positive:?}");
    }

    #[test]
    fn one_side_needs_a_null() {
        let readings: Vec<FlowReading> =
            swept(2e-8, [0.4, 0.4], 0.0, false).into_iter().filter(|one| one.input >= 0.0).collect();
        let refused = static_valve(&readings, None).unwrap_err();
        assert!(
            matches!(refused, StaticTestError::NullUnknown { crossing } if (crossing - 0.4).abs() < 0.02),
            "{refused}"
        );
        let found = static_valve(&readings, Some(0.1)).unwrap();
        assert!((found.sides[0].unwrap().dead_zone.value - 0.3).abs() < 0.02 && found.sides[1].is_none());
    }

    #[test]
    fn what_is_no_test_gives_nothing() {
        let no_line = |readings: &[FlowReading]| {
            assert!(matches!(static_valve(readings, None), Err(StaticTestError::NoLine { .. })));
        };
        no_line(&[]);
        no_line(&[FlowReading { input: f64::NAN, flow: f64::NAN, pressure_drop: 0.0 }; 50]);
        no_line(&[FlowReading { input: 1.0, flow: 0.0, pressure_drop: 1e5 }; 50]);
    }
}
