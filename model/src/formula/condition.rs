//! A condition on the samples of a recording: `abs(v) > 0.002`.

use super::compile::compile_difference;
use super::error::{FormulaError, Problem};
use super::names::Names;
use super::parser::parse_condition;
use super::program::{Moment, Program};
use super::symbol::Symbol;
use super::variable::Variable;
use crate::equations::Situation;
use crate::machine::Machine;
use crate::recording::{CylinderSignals, Recording, is_measured, slopes};

/// A comparison of two expressions of measured signals. Its numbers are in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// Above zero where the condition holds.
    difference: Program,
}

impl Condition {
    /// Parses a condition.
    ///
    /// # Errors
    /// [`FormulaError`], in one line with the position.
    pub fn read(text: &str) -> Result<Condition, FormulaError> {
        let sides = parse_condition(text, &Names { parameters: &[], states: &[], rates: false })?;
        for (symbol, at) in sides.iter().flat_map(super::expression::Expression::names) {
            if let Symbol::Variable(variable, _) = symbol
                && let Some(reason) = why_not(*variable)
            {
                let name = variable.card().name.to_string();
                return Err(FormulaError::new(Problem::Unavailable { name, reason }, at, text));
            }
        }
        let unit_of = |symbol: &Symbol| match symbol {
            Symbol::Variable(variable, _) => variable.dimension(),
            // The list of names is empty, so these do not occur.
            Symbol::Parameter(_) | Symbol::State(_) => super::dimension::Dimension::PURE,
        };
        Ok(Condition { difference: compile_difference(&sides, text, &unit_of)? })
    }

    /// Whether it holds, for each cylinder of `machine` sample by sample. It does not hold where a signal that it uses was not
    /// measured.
    pub fn holds(&self, machine: &Machine, recording: &Recording) -> Vec<Vec<bool>> {
        let mut now: Situation<'_, f64> = Situation::empty(machine);
        let own: Vec<Option<&CylinderSignals>> =
            machine.cylinders.iter().map(|cylinder| recording.cylinder(&cylinder.name).ok()).collect();
        let velocities: Vec<Vec<f64>> = own
            .iter()
            .map(|signals| signals.map_or_else(Vec::new, |signals| velocity(&recording.time, signals, now.time_scale)))
            .collect();
        let mut holds = vec![vec![false; recording.len()]; machine.cylinders.len()];
        for sample in 0..recording.len() {
            now.time = recording.time[sample];
            now.pump_pressure = recording.pump_pressure[sample];
            now.tank_pressure = recording.tank_pressure[sample];
            now.oil_temperature = recording.oil_temperature[sample];
            for (number, signals) in own.iter().enumerate() {
                let Some(signals) = signals else { continue };
                let piston = &mut now.pistons[number];
                let linkage = &machine.cylinders[number].linkage;
                piston.displacement = signals.displacement[sample];
                piston.joint = signals.joint_angle[sample];
                if piston.joint.is_nan() {
                    piston.joint = linkage.joint(piston.displacement);
                } else if piston.displacement.is_nan() {
                    piston.displacement = linkage.displacement(piston.joint);
                }
                piston.lever = linkage.lever(piston.joint);
                piston.velocity = velocities[number][sample];
                piston.rate = piston.velocity / piston.lever;
                piston.cap_pressure = signals.cap_pressure[sample];
                piston.rod_pressure = signals.rod_pressure[sample];
                piston.rod_force = signals.rod_force[sample];
                let (measured, command) = (signals.orifice_area[sample], signals.orifice_command[sample]);
                piston.command = if measured.is_nan() { command } else { measured };
                piston.opening = piston.command;
            }
            for (number, holds) in holds.iter_mut().enumerate() {
                let moment = Moment { parameters: &[], states: &[], now: &now, cylinder: Some(number), opening: None };
                holds[sample] = self.difference.evaluate(&moment) > 0.0;
            }
        }
        holds
    }
}

fn why_not(variable: Variable) -> Option<&'static str> {
    match variable {
        Variable::CapFlow | Variable::RodFlow => Some("no recording has it"),
        _ => None,
    }
}

/// Half width of the window of the straight line for the velocity: in s, on a machine of the reference size; and in samples.
const HALF_WIDTH: (f64, usize) = (0.02, 2);

/// The measured velocity, or the slope of the displacement, m/s.
fn velocity(time: &[f64], signals: &CylinderSignals, time_scale: f64) -> Vec<f64> {
    if is_measured(&signals.velocity) {
        return signals.velocity.clone();
    }
    slopes(time, &signals.displacement, (HALF_WIDTH.0 * time_scale, HALF_WIDTH.1))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::document::built_in;

    fn recording() -> Recording {
        let time: Vec<f64> = (0..1000).map(|index| f64::from(index) * 2e-3).collect();
        let mut recording = Recording::unmeasured("made up", time, &["arm"]);
        // Rests for a second, then moves at 0.1 m/s.
        recording.cylinders[0].displacement = recording.time.iter().map(|t| 0.1 * (t - 1.0).max(0.0)).collect();
        recording.pump_pressure = recording.time.iter().map(|t| 1e6 * t).collect();
        recording
    }

    fn share(text: &str) -> f64 {
        let machine = built_in("zx30u-arm").unwrap().machine;
        let holds = &Condition::read(text).unwrap().holds(&machine, &recording())[0];
        holds.iter().filter(|holds| **holds).count() as f64 / holds.len() as f64
    }

    #[test]
    fn conditions_select_samples() {
        assert!((share("abs(v) > 0.05") - 0.5).abs() < 0.01);
        assert!((share("abs(v) < 0.05") - 0.5).abs() < 0.01);
        assert!((share("p_pump >= 5e5") - 0.75).abs() < 0.01);
        assert!((share("t < 0.4*2") - 0.4).abs() < 0.01);
        // A condition on an unmeasured signal does not hold, whatever the comparison.
        assert_eq!((share("p_cap > 0"), share("p_cap < 0")), (0.0, 0.0));
    }

    #[test]
    fn what_is_no_condition_is_one_clear_line() {
        let complaint = |text: &str| Condition::read(text).unwrap_err().to_string();
        assert!(complaint("abs(v)").contains("expected a comparison"), "{}", complaint("abs(v)"));
        assert!(complaint("v > p_cap").contains("cannot compare"), "{}", complaint("v > p_cap"));
        assert!(complaint("speed > 1").contains("unknown name"), "{}", complaint("speed > 1"));
        assert!(complaint("0 < v < 1").contains("chained"), "{}", complaint("0 < v < 1"));
    }
}
