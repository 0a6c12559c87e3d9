//! Identifies a valve from its static test: flow against input at a known pressure drop on a flow bench.

use nalgebra::{DMatrix, DVector};

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

/// Result of a static test for one direction of the input: `Q = g (|u| - z) sqrt(drop)`. z is larger by half the play while the
/// valve opens and smaller by half the play while it closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticEdge {
    /// Flow gain g per input and root of the pressure drop, m³/(s sqrt(Pa)) per unit of the input.
    pub gain: Estimate,
    /// Input z that moves no oil, in its unit.
    pub dead_zone: Estimate,
    /// Difference in input between opening and closing, in its unit; `None` if the test runs in one direction only.
    pub play: Option<Estimate>,
    /// Number of readings used.
    pub readings: usize,
}

/// Shares of the largest flow between which the line is fitted. Below, edges leak and overlap is rounded; above, flow forces and
/// channels other than the edge dominate.
const STRAIGHT: [f64; 2] = [0.1, 0.9];

/// Fewest readings for a line.
const FEWEST: usize = 6;

/// Both directions of the input: above zero and below. `None` if too few readings lie on the straight part.
pub fn static_valve(readings: &[FlowReading]) -> [Option<StaticEdge>; 2] {
    [1.0, -1.0].map(|side| static_edge(readings, side))
}

fn static_edge(readings: &[FlowReading], side: f64) -> Option<StaticEdge> {
    let area = |one: &FlowReading| one.flow.abs() / one.pressure_drop.abs().sqrt();
    let of_side = |one: &&FlowReading| one.input * side > 0.0 && area(one).is_finite();
    let largest = readings.iter().filter(of_side).map(area).fold(0.0_f64, f64::max);
    let mut opens = true;
    let mut straight: Vec<(f64, f64, bool)> = Vec::new();
    for (before, now) in readings.iter().zip(readings.iter().skip(1)) {
        let (last, input) = (before.input * side, now.input * side);
        // A reading at an unchanged input belongs to the current sweep.
        if input != last {
            opens = input > last;
        }
        let inside = area(now) >= STRAIGHT[0] * largest && area(now) <= STRAIGHT[1] * largest;
        if input > 0.0 && inside {
            straight.push((input, area(now), opens));
        }
    }
    let both_ways = [true, false].iter().all(|way| straight.iter().filter(|one| one.2 == *way).count() >= FEWEST / 2);
    if straight.len() < FEWEST || largest <= 0.0 {
        return None;
    }
    let columns = if both_ways { 3 } else { 2 };
    let matrix = DMatrix::from_fn(straight.len(), columns, |row, column| match column {
        0 => straight[row].0,
        1 => 1.0,
        // Plus and minus half of the play.
        _ if straight[row].2 => 0.5,
        _ => -0.5,
    });
    let flows = DVector::from_iterator(straight.len(), straight.iter().map(|one| one.1));
    let normal = (matrix.transpose() * &matrix).try_inverse()?;
    let solution = &normal * matrix.transpose() * &flows;
    let residual = (&flows - &matrix * &solution).norm_squared();
    let variance = residual / (straight.len() - columns).max(1) as f64;
    let gain = solution[0];
    if !gain.is_finite() || gain <= 0.0 {
        return None;
    }
    let error = |column: usize| (variance * normal[(column, column)]).sqrt();
    // z = -c/g: errors of both with their covariance.
    let ratio = |column: usize| {
        let value = -solution[column] / gain;
        let shared = variance * normal[(0, column)];
        let squares = error(column).powi(2) + (value * error(0)).powi(2) + 2.0 * value * shared;
        Estimate { value, error: squares.max(0.0).sqrt() / gain }
    };
    Some(StaticEdge {
        gain: Estimate { value: gain, error: error(0) },
        dead_zone: ratio(1),
        play: both_ways.then(|| ratio(2)),
        readings: straight.len(),
    })
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

    #[test]
    fn gain_dead_zone_and_play_are_found() {
        let [positive, negative] = static_valve(&swept(2e-8, [0.4, 0.6], 0.3, true)).map(Option::unwrap);
        for (edge, zone) in [(positive, 0.4), (negative, 0.6)] {
            assert!((edge.gain.value / 2e-8 - 1.0).abs() < 0.01, "{edge:?}");
            assert!((edge.dead_zone.value - zone).abs() < 0.03, "{edge:?}");
            assert!((edge.play.unwrap().value - 0.3).abs() < 0.03, "{edge:?}");
            assert!((edge.dead_zone.value - zone).abs() < 4.0 * edge.dead_zone.error + 1e-3, "{edge:?}");
        }
    }

    #[test]
    fn one_way_says_nothing_of_a_play() {
        let [positive, negative] = static_valve(&swept(2e-8, [0.0, 0.0], 0.0, false)).map(Option::unwrap);
        // From -10 V upwards, the valve closes on the negative side and opens on the positive one.
        assert_eq!((positive.play, negative.play), (None, None));
        assert!(positive.dead_zone.value.abs() < 0.02, "{positive:?}");
    }

    #[test]
    fn what_is_no_test_gives_nothing() {
        assert_eq!(static_valve(&[]), [None, None]);
        let nan = FlowReading { input: f64::NAN, flow: f64::NAN, pressure_drop: 0.0 };
        assert_eq!(static_valve(&[nan; 50]), [None, None]);
        let dry = FlowReading { input: 1.0, flow: 0.0, pressure_drop: 1e5 };
        assert_eq!(static_valve(&[dry; 50]), [None, None]);
    }
}
