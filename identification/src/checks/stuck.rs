//! Finds sensors that read one value while the machine works.

use excavator_model::recording::{Recording, is_measured, noise_level, resolution};

use super::CheckError;
use super::opening::{largest, open_one_way};
use super::runs::{Run, range, runs, spread};

/// Shortest time that is reported, s: a late message repeats a value for less.
const SHORTEST: f64 = 1.0;

/// Share of its range that another signal must move for a time to count as eventful.
const EVENTFUL: f64 = 0.1;

/// Pressure, Pa, below which a constant reading may be real: a chamber open to the tank, with a sensor that reads no pressure
/// below zero.
const NEAR_TANK: f64 = 2e5;

/// Share of a piston's range at each end in which a constant reading may be real, at a stop.
const NEAR_THE_END: f64 = 0.05;

/// Step of the converter, as a share of the signal's range, above which it is coarse. The noise is then smaller than a step and
/// does not show whether the sensor works.
const COARSE: f64 = 5e-3;

/// Noise of a sensor, in converter steps, above which a second without noise means that the sensor is dead.
const ALIVE: f64 = 2.0;

/// When a sensor is stuck, and at which value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    begin: f64,
    end: f64,
    value: f64,
}

impl Stretch {
    /// The error to report.
    pub fn error(self, recording: &Recording, signal: String, unit: &'static str) -> CheckError {
        let Stretch { begin, end, value } = self;
        CheckError::Stuck { source_name: recording.source.clone(), signal, value, unit, begin, end }
    }

    fn of(run: Run, time: &[f64]) -> Self {
        Stretch { begin: time[run.first], end: time[run.last], value: run.value }
    }
}

/// The longest stretch in which a pressure keeps one value although all measured signals in `witnesses` move.
pub(super) fn stuck_pressure(time: &[f64], signal: &[f64], witnesses: &[&[f64]], time_scale: f64) -> Option<Stretch> {
    if resolution(signal) > COARSE * spread(signal) {
        return None;
    }
    longest(time, signal, time_scale, |run| run.value.abs() >= NEAR_TANK && all_move(witnesses, run))
}

/// The longest stretch in which a piston seems to rest although both pressures change. In addition, either its valve is open one
/// way all the time and the piston is away from its ends, or its valve moves and the sensor has noise everywhere else.
pub(super) fn stuck_position(
    time: &[f64],
    signal: &[f64],
    opening: &[f64],
    pressures: &[&[f64]],
    time_scale: f64,
) -> Option<Stretch> {
    let (least, most) = range(signal);
    let margin = NEAR_THE_END * (most - least);
    let largest = largest(opening);
    let has_noise = noise_level(signal) > ALIVE * resolution(signal);
    longest(time, signal, time_scale, |run| {
        let inside = run.value > least + margin && run.value < most - margin;
        let is_driven = inside && open_one_way(&opening[run.first..=run.last], largest);
        let is_silent = has_noise && all_move(&[opening], run);
        largest > 0.0 && (is_driven || is_silent) && all_move(pressures, run)
    })
}

/// The whole recording, if a force keeps one value while the piston moves.
pub(super) fn never_changes(time: &[f64], force: &[f64], displacement: &[f64], time_scale: f64) -> Option<Stretch> {
    let (Some(&begin), Some(&end), Some(&value)) = (time.first(), time.last(), force.iter().find(|f| f.is_finite()))
    else {
        return None;
    };
    let moves = is_measured(displacement) && spread(displacement) > 0.0;
    (moves && end - begin >= SHORTEST * time_scale && spread(force) == 0.0).then_some(Stretch { begin, end, value })
}

fn longest(time: &[f64], signal: &[f64], time_scale: f64, is_stuck: impl Fn(&Run) -> bool) -> Option<Stretch> {
    runs(signal)
        .into_iter()
        .filter(|run| time[run.last] - time[run.first] >= SHORTEST * time_scale && is_stuck(run))
        .max_by_key(Run::len)
        .map(|run| Stretch::of(run, time))
}

/// Whether at least one signal is measured, and all measured ones move during the run.
fn all_move(witnesses: &[&[f64]], run: &Run) -> bool {
    let mut measured = witnesses.iter().filter(|signal| is_measured(signal)).peekable();
    measured.peek().is_some()
        && measured.all(|signal| {
            let all = spread(signal);
            all > 0.0 && spread(&signal[run.first..=run.last]) > EVENTFUL * all
        })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::{never_changes, stuck_position, stuck_pressure};

    fn wave(scale: f64, time: &[f64]) -> Vec<f64> {
        time.iter().map(|t| scale * (2.0 + (2.0 * t).sin())).collect()
    }

    #[test]
    fn a_force_that_never_changes_is_found() {
        let time: Vec<f64> = (0..1000).map(|index| index as f64 * 0.01).collect();
        let piston = wave(0.1, &time);
        assert!(never_changes(&time, &vec![0.0; 1000], &piston, 1.0).is_some());
        assert!(never_changes(&time, &wave(100.0, &time), &piston, 1.0).is_none());
        assert!(never_changes(&time, &vec![0.0; 1000], &vec![0.2; 1000], 1.0).is_none());
        assert!(never_changes(&time, &vec![f64::NAN; 1000], &piston, 1.0).is_none());
    }

    #[test]
    fn a_sensor_that_stops_is_found_and_one_at_tank_pressure_is_not() {
        let time: Vec<f64> = (0..1000).map(|index| index as f64 * 0.01).collect();
        let (mut cap, rod) = (wave(1e6, &time), wave(2e6, &time));
        assert_eq!(stuck_pressure(&time, &cap, &[&rod], 1.0), None);
        let held = cap[300];
        cap[300..500].fill(held);
        let found = stuck_pressure(&time, &cap, &[&rod], 1.0).unwrap();
        assert_eq!((found.begin, found.end, found.value), (3.0, 4.99, held));
        cap[300..500].fill(0.0);
        assert_eq!(stuck_pressure(&time, &cap, &[&rod], 1.0), None);
        // A machine at rest: nothing happens.
        cap[300..500].fill(held);
        let resting = vec![1e6; 1000];
        assert_eq!(stuck_pressure(&time, &cap, &[&resting], 1.0), None);
    }

    #[test]
    fn a_piston_may_stand_at_its_stop_but_not_half_way_with_an_open_valve() {
        let time: Vec<f64> = (0..1000).map(|index| index as f64 * 0.01).collect();
        let pressures = (wave(1e6, &time), wave(2e6, &time));
        let witnesses: [&[f64]; 2] = [&pressures.0, &pressures.1];
        let open = vec![1e-5; 1000];
        let mut position: Vec<f64> = time.iter().map(|t| (t / 8.0).min(1.0)).collect();
        assert_eq!(stuck_position(&time, &position, &open, &witnesses, 1.0), None);
        position[300..450].fill(0.37);
        assert_eq!(stuck_position(&time, &position, &open, &witnesses, 1.0).unwrap().value, 0.37);
        let closed = vec![0.0; 1000];
        assert_eq!(stuck_position(&time, &position, &closed, &witnesses, 1.0), None);
        // A valve that opens both ways may leave a piston in place, but its sensor still has noise.
        let both_ways: Vec<f64> = time.iter().map(|t| 1e-5 * (3.0 * t).sin()).collect();
        assert_eq!(stuck_position(&time, &position, &both_ways, &witnesses, 1.0), None);
        for (index, value) in position.iter_mut().enumerate() {
            *value += 1e-4 * ((index * index) as f64 * 0.7).sin();
        }
        assert_eq!(stuck_position(&time, &position, &both_ways, &witnesses, 1.0), None);
        position[300..450].fill(0.37);
        assert_eq!(stuck_position(&time, &position, &both_ways, &witnesses, 1.0).unwrap().value, 0.37);
    }
}
