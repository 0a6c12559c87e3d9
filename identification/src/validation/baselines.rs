//! Baselines for errors: those of sensor noise, of a held value and of a model without physics on the same signals.

use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_model::simulation::InputSignals;

use super::arx::simulated_arx;
use super::{Comparison, normalised_mean_squared_error};

/// Time over which a signal is held for [`Baseline::held`], on a machine of the reference size, s.
const HELD: f64 = 1.0;
/// Sample interval of the ARX models, on a machine of the reference size, s. A tenth of an arm's fastest swing is 10
/// ms.
const ARX_INTERVAL: f64 = 0.02;

/// Tolerance for the rounding of times, s.
const ROUNDING: f64 = 1e-7;

/// Normalised mean squared errors that a model's error is compared with, for one signal. `NaN` if there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Baseline {
    /// Error of sensor noise alone, a lower bound for any model in the long run.
    pub noise: f64,
    /// Error of the value from [`Baselines::held`] seconds before.
    pub held: f64,
    /// Error of a simulated linear ARX model that was fitted to this same recording.
    pub arx: f64,
}

/// The baselines of a comparison's signals, in their order.
#[derive(Debug, Clone, PartialEq)]
#[must_use]
pub struct Baselines {
    /// One for each signal.
    pub signals: Vec<Baseline>,
    /// Time for which a value is held, s.
    pub held: f64,
}

impl Baselines {
    /// The baselines for the signals of `comparison`, as measured in `recording`.
    pub fn of(model: &Model, recording: &Recording, comparison: &Comparison) -> Baselines {
        let unit = model.machine.size().time();
        let held = HELD * unit;
        let stride = ((ARX_INTERVAL * unit / recording.sample_interval()).round() as usize).max(1);
        let thinned = Thinned::of(model, recording, stride);
        let signals = comparison
            .signals
            .iter()
            .map(|signal| {
                let measured = comparison.measured.signal(&signal.name).unwrap_or(&[]);
                Baseline {
                    noise: signal.error.normalised_noise(),
                    held: held_error(&recording.time, measured, held),
                    arx: thinned.arx_error(measured),
                }
            })
            .collect();
        Baselines { signals, held }
    }

    /// Mean over the signals that have this baseline; `NaN` if none has.
    pub fn mean(&self, of: impl Fn(&Baseline) -> f64) -> f64 {
        let known: Vec<f64> = self.signals.iter().map(of).filter(|value| value.is_finite()).collect();
        known.iter().sum::<f64>() / known.len() as f64
    }
}

fn held_error(time: &[f64], signal: &[f64], held: f64) -> f64 {
    let mut before = 0;
    let past: Vec<f64> = time
        .iter()
        .map(|now| {
            while before + 1 < time.len() && time[before + 1] <= now - held + ROUNDING {
                before += 1;
            }
            let is_there = time[before] <= now - held + ROUNDING && now - held - time[before] < held;
            if is_there { signal.get(before).copied().unwrap_or(f64::NAN) } else { f64::NAN }
        })
        .collect();
    normalised_mean_squared_error(signal, &past)
}

/// Thinned inputs, in pieces without a gap.
struct Thinned {
    kept: Vec<usize>,
    pieces: Vec<std::ops::Range<usize>>,
    inputs: Vec<Vec<f64>>,
}

impl Thinned {
    fn of(model: &Model, recording: &Recording, stride: usize) -> Thinned {
        let (mut kept, mut pieces) = (Vec::new(), Vec::new());
        for piece in recording.pieces() {
            let first = kept.len();
            kept.extend(piece.step_by(stride));
            pieces.push(first..kept.len());
        }
        let at = |values: &[f64]| kept.iter().map(|&index| values[index]).collect::<Vec<f64>>();
        let mut inputs = Vec::new();
        if let Ok(signals) = InputSignals::from_recording(model, recording) {
            for (number, cylinder) in model.machine.cylinders.iter().enumerate() {
                if cylinder.chambers.is_some() {
                    inputs.push(at(signals.orifice_area(number)));
                } else if let Ok(own) = recording.cylinder(&cylinder.name) {
                    inputs.push(at(if cylinder.imposed_motion.is_some() { &own.velocity } else { &own.rod_force }));
                }
            }
        }
        inputs.push(at(&recording.pump_flow));
        inputs.retain(|input| input.iter().all(|value| value.is_finite()));
        Thinned { kept, pieces, inputs }
    }

    fn arx_error(&self, measured: &[f64]) -> f64 {
        // Slopes have holes at the ends of the recording. The nearest value replaces them.
        let mut own: Vec<f64> =
            self.kept.iter().map(|&index| measured.get(index).copied().unwrap_or(f64::NAN)).collect();
        fill_ends(&mut own);
        simulated_arx(&own, &self.inputs, &self.pieces)
            .map_or(f64::NAN, |simulated| normalised_mean_squared_error(&own, &simulated))
    }
}

fn fill_ends(values: &mut [f64]) {
    let (Some(first), Some(last)) =
        (values.iter().position(|value| value.is_finite()), values.iter().rposition(|value| value.is_finite()))
    else {
        return;
    };
    let (begin, end) = (values[first], values[last]);
    values[..first].fill(begin);
    values[last + 1..].fill(end);
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::validation::compare;
    use excavator_model::document::built_in;
    use excavator_model::simulation::{Tolerances, simulate_from_rest};

    #[test]
    fn the_machine_itself_beats_what_knows_no_physics() {
        let model = built_in("zx30u-arm").unwrap();
        let time: Vec<f64> = (0..10_000).map(|k| f64::from(k) * 2e-3).collect();
        let mut recording = Recording::unmeasured("bag", time, &["arm"]);
        recording.tank_pressure.fill(3e5);
        recording.pump_flow.fill(3.8e-4);
        recording.cylinders[0].orifice_area =
            recording.time.iter().map(|t| 4e-5 * (1.9 * t).sin() + 2e-5 * (5.1 * t).sin()).collect();
        let recording = simulate_from_rest(&model, &recording, &[0.0], Tolerances::default()).unwrap();
        let comparison = compare(&model, &recording).unwrap();
        let baselines = Baselines::of(&model, &recording, &comparison);
        assert_eq!(baselines.signals.len(), comparison.signals.len());
        assert!((baselines.held - 1.0).abs() < 0.2, "{}", baselines.held);
        for (signal, baseline) in comparison.signals.iter().zip(&baselines.signals) {
            assert!(
                baseline.arx > 10.0 * signal.error.normalised() && baseline.arx.is_finite(),
                "{signal:?} {baseline:?}"
            );
            assert!(baseline.held > 0.01, "{signal:?} {baseline:?}");
        }
        assert!(baselines.mean(|one| one.arx) < 1.0, "{baselines:?}");
    }

    #[test]
    fn a_held_value_is_the_one_so_long_before() {
        let time: Vec<f64> = (0..1000).map(|k| f64::from(k) * 0.01).collect();
        let signal: Vec<f64> = time.iter().map(|t| (std::f64::consts::TAU * t).sin()).collect();
        // After one second the signal has the same value, after half a second the opposite sign.
        assert!(held_error(&time, &signal, 1.0) < 1e-9);
        assert!((held_error(&time, &signal, 0.5) - 4.0).abs() < 0.1);
    }
}
