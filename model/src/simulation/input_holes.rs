//! Finds intervals of a recording in which an input is unknown.

use crate::Model;
use crate::machine::Supply;
use crate::recording::{CylinderSignals, Recording};

/// Most sample intervals of an input that a straight line may bridge: a lost cell or message, not a manoeuvre.
const BRIDGED: usize = 10;

/// Intervals in which an input of a model is missing for longer than a line may bridge.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct InputHoles {
    /// Samples at which every input is known or can be bridged.
    pub known: Vec<usize>,
    /// Number of holes.
    pub count: usize,
    /// Longest hole, s.
    pub longest: f64,
    /// Total duration of the holes, s.
    pub total: f64,
}

/// The holes in the inputs of `model` within a recording. An input that is not measured at all is not a hole, and neither are
/// missing values before the first value or after the last one.
pub fn input_holes(model: &Model, recording: &Recording) -> InputHoles {
    let mut hidden = vec![false; recording.len()];
    for cylinder in &model.machine.cylinders {
        let Ok(signals) = recording.cylinder(&cylinder.name) else { continue };
        let input = if cylinder.chambers.is_some() { valve_input(signals) } else { &signals.rod_force };
        mark_holes(input, &mut hidden);
    }
    if matches!(model.machine.supply, Supply::PressureSource(_)) {
        mark_holes(&recording.pump_pressure, &mut hidden);
    }
    let mut holes = InputHoles { known: Vec::new(), count: 0, longest: 0.0, total: 0.0 };
    let mut begin: Option<usize> = None;
    for (sample, &hides) in hidden.iter().enumerate() {
        match (hides, begin) {
            (true, None) => begin = Some(sample),
            (false, Some(first)) => {
                let duration = recording.time[sample] - recording.time[first];
                holes.count += 1;
                holes.longest = holes.longest.max(duration);
                holes.total += duration;
                begin = None;
            }
            _ => {}
        }
        if !hides {
            holes.known.push(sample);
        }
    }
    holes
}

fn valve_input(signals: &CylinderSignals) -> &[f64] {
    if signals.orifice_area.iter().any(|area| area.is_finite()) {
        &signals.orifice_area
    } else {
        &signals.orifice_command
    }
}

/// Marks the intervals without a value that are longer than [`BRIDGED`], between the first value and the last.
fn mark_holes(input: &[f64], hidden: &mut [bool]) {
    let mut last_known: Option<usize> = None;
    for (sample, value) in input.iter().enumerate() {
        if value.is_nan() {
            continue;
        }
        if let Some(before) = last_known
            && sample - before > BRIDGED + 1
        {
            hidden[before + 1..sample].fill(true);
        }
        last_known = Some(sample);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::document::built_in;

    #[test]
    fn long_holes_are_found_and_short_ones_bridged() {
        let model = built_in("zx30u-arm").unwrap();
        let time = (0..1000).map(|sample| f64::from(sample) * 2e-3).collect();
        let mut recording = Recording::unmeasured("bag", time, &["arm"]);
        let input = &mut recording.cylinders[0].orifice_area;
        input.fill(1e-5);
        input[..50].fill(f64::NAN);
        input[100..110].fill(f64::NAN);
        input[300..340].fill(f64::NAN);
        let holes = input_holes(&model, &recording);
        assert_eq!((holes.count, holes.known.len()), (1, 960));
        assert!((holes.longest - 0.08).abs() < 1e-12 && (holes.total - 0.08).abs() < 1e-12);
        recording.cylinders[0].orifice_area.fill(f64::NAN);
        assert_eq!(input_holes(&model, &recording).count, 0);
    }
}
