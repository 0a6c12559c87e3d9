//! Compares two runs of one machine. Their difference is a lower bound for the error of any model.

use excavator_model::Model;
use excavator_model::recording::{Recording, linear};
use excavator_model::simulation::{InputSignals, RunError};

use super::compare::beside;
use super::{Comparison, measured_velocity, normalised_mean_squared_error};

/// Points of the grid on which two runs are aligned: with a run of a minute, one every 15 ms.
const GRID: usize = 4000;
/// Smallest overlap, as a share of the shorter run.
const LEAST_OVERLAP: f64 = 0.5;

/// Normalised difference below which commands count as the same. It allows for a hand on a lever, or another clock.
const SAME_COMMANDS: f64 = 0.05;

/// Two runs, aligned and compared.
#[derive(Debug, Clone)]
pub struct Repeat {
    /// The first run as the measurement, the second one as the simulation.
    pub comparison: Comparison,
    /// Time that was added to the timestamps of the second run, s.
    pub shift: f64,
    /// Normalised mean squared difference of the commands.
    pub command_error: f64,
}

impl Repeat {
    /// Whether both runs had the same commands, so that their difference shows the repeatability of the machine.
    pub fn has_same_commands(&self) -> bool {
        self.command_error < SAME_COMMANDS
    }
}

/// Compares two runs, the second one shifted so that the commands agree best.
///
/// # Errors
/// [`RunError`] if a recording lacks the inputs of the model.
pub fn compare_runs(model: &Model, run: &Recording, again: &Recording) -> Result<Repeat, RunError> {
    let (first, second) = (command(model, run)?, command(model, again)?);
    let shift = alignment(&first, &second);
    let moved: Vec<f64> = first.0.iter().map(|&time| inside(&second, time - shift)).collect();
    let command_error = normalised_mean_squared_error(&first.1, &moved);
    let mut again = again.clone();
    for (cylinder, velocity) in model.machine.cylinders.iter().zip(measured_velocity(model, &again)?) {
        if let Some(signals) = again.cylinders.iter_mut().find(|signals| signals.name == cylinder.name) {
            signals.velocity = velocity;
        }
    }
    let times: Vec<f64> = run.time.iter().map(|time| time - shift).collect();
    let aligned = again.interpolated(&times);
    Ok(Repeat { comparison: beside(model, run, aligned)?, shift, command_error })
}

/// Value at a time; `NaN` outside the recording.
fn inside((time, values): &(Vec<f64>, Vec<f64>), at: f64) -> f64 {
    let range = time.first().copied().unwrap_or(0.0)..=time.last().copied().unwrap_or(0.0);
    if range.contains(&at) { linear(time, values, at) } else { f64::NAN }
}

/// Times and the input of the first cylinder: its opening, or its displacement if the model has no chambers.
fn command(model: &Model, recording: &Recording) -> Result<(Vec<f64>, Vec<f64>), RunError> {
    let values = if model.machine.has_chambers() {
        InputSignals::from_recording(model, recording)?.orifice_area(0).to_vec()
    } else {
        recording.cylinders.first().map(|cylinder| cylinder.displacement.clone()).unwrap_or_default()
    };
    Ok((recording.time.clone(), values))
}

/// The shift of the second signal that brings it closest to the first one, s. It is searched on a coarse grid, then on
/// finer ones.
fn alignment(first: &(Vec<f64>, Vec<f64>), second: &(Vec<f64>, Vec<f64>)) -> f64 {
    let duration = |signal: &(Vec<f64>, Vec<f64>)| signal.0.last().copied().unwrap_or(0.0);
    let shorter = duration(first).min(duration(second));
    let step = duration(first).max(duration(second)) / GRID as f64;
    if shorter <= 0.0 || step <= 0.0 {
        return 0.0;
    }
    let most = (1.0 - LEAST_OVERLAP) * shorter;
    let nearest = |around: f64, width: f64, step: f64| {
        let count = (width / step).ceil() as i64;
        let candidates = (-count..=count).map(|k| around + k as f64 * step);
        let distances = candidates.map(|shift| (shift, distance(first, second, shift)));
        distances.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(around, |best| best.0)
    };
    // Each finer grid covers one step of the coarser one on either side, so that it contains the best shift.
    let coarse = nearest(0.0, most, 4.0 * step);
    let middle = nearest(coarse, 4.0 * step, step);
    nearest(middle, step, 0.1 * step)
}

/// Mean squared difference in the overlap of both runs; infinite if they hardly overlap.
fn distance(first: &(Vec<f64>, Vec<f64>), second: &(Vec<f64>, Vec<f64>), shift: f64) -> f64 {
    let (time, values) = first;
    let stride = time.len().div_ceil(GRID).max(1);
    let (mut sum, mut count) = (0.0, 0_usize);
    for (&at, &value) in time.iter().zip(values).step_by(stride) {
        let difference = value - inside(second, at - shift);
        if difference.is_finite() {
            sum += difference * difference;
            count += 1;
        }
    }
    let enough = (LEAST_OVERLAP * time.len().min(second.0.len()) as f64 / stride as f64) as usize;
    if count > 0 && 2 * count >= enough { sum / count as f64 } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_is_found_on_clocks_of_different_rates() {
        let pulse = |t: f64| if (3.0..5.0).contains(&t) { 1.0 } else { (0.7 * t).sin() * 0.1 };
        let run = |rate: f64, start: f64| -> (Vec<f64>, Vec<f64>) {
            let time: Vec<f64> = (0..(10.0 * rate) as usize).map(|k| k as f64 / rate).collect();
            let values = time.iter().map(|t| pulse(t + start)).collect();
            (time, values)
        };
        let shift = alignment(&run(500.0, 0.0), &run(200.0, 1.37));
        assert!((shift - 1.37).abs() < 5e-3, "{shift}");
        assert_eq!(alignment(&(vec![], vec![]), &run(10.0, 0.0)), 0.0);
    }
}
