//! Computes the opening of a valve from the wanted joint position and rate.
//!
//! Position error and wanted rate give a piston speed. Its share of the full speed gives the opening. An integral of the speed
//! error corrects for the effect of an open-centre valve, a load or a dead zone. The controller is meant to move a simulated
//! machine, with gains for machines of this class. It is not approved for any real machine.

use excavator_model::Model;
use excavator_model::machine::{Cylinder, Drive, Supply};

/// Target of a joint. `NaN` = no target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wanted {
    /// Position, rad, or m for a sliding joint.
    pub position: f64,
    /// Rate, rad/s or m/s.
    pub rate: f64,
}

/// Gains of every joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gains {
    /// Joint rate per unit of position error, 1/s.
    pub position: f64,
    /// Opening, as a share of the largest, per missing piston travel, as a share of full speed times one second; 1/s.
    pub integral: f64,
}

/// One joint under control.
#[derive(Debug, Clone)]
pub struct JointLaw {
    cylinder: Cylinder,
    /// Largest opening, m².
    opening: f64,
    /// Piston speed with the full flow of the supply, extending and retracting, m/s.
    full_speed: [f64; 2],
    /// Integral part, as a share of the largest opening.
    integral: f64,
    /// Joint position and time of the previous sample, for the rate.
    before: Option<(f64, f64)>,
}

impl JointLaw {
    /// The law of each cylinder that has a valve; `None` for the others.
    ///
    /// # Errors
    /// A message, if the model does not determine how fast a valve moves its cylinder.
    pub fn of(model: &Model) -> Result<Vec<Option<JointLaw>>, String> {
        model.machine.cylinders.iter().map(|cylinder| Self::of_cylinder(model, cylinder)).collect()
    }

    fn of_cylinder(model: &Model, cylinder: &Cylinder) -> Result<Option<JointLaw>, String> {
        let Some(chambers) = cylinder.chambers else { return Ok(None) };
        let (Drive::Valve { .. }, opening) = (chambers.drive, chambers.full_command()) else { return Ok(None) };
        let areas = [chambers.cap_area, chambers.rod_area];
        let flow = match model.machine.supply {
            Supply::PumpLine(line) => line.flow,
            Supply::PressureSource(source) => {
                let gain = model.value_of(&format!("{}.flow_gain_cap", cylinder.name));
                let gain = gain.ok_or_else(|| format!("the model has no flow gain of {}", cylinder.name))?;
                // Assumes that half of the supply pressure drops across the meter-in edge.
                gain * opening * (source.pressure / 2.0).sqrt()
            }
            Supply::None => return Err(format!("{} has no oil supply in the model", cylinder.name)),
        };
        let full_speed = areas.map(|area| flow / area);
        Ok(Some(JointLaw { cylinder: cylinder.clone(), opening, full_speed, integral: 0.0, before: None }))
    }

    /// Piston speed with the full flow of the supply, in the slower direction, m/s.
    pub fn full_speed(&self) -> f64 {
        self.full_speed[0].min(self.full_speed[1])
    }

    /// Returns the opening (m²) for a joint at `position` at `time` (s), and the joint's rate. Positions may come at any rate,
    /// in order.
    pub(super) fn step(&mut self, wanted: Wanted, gains: Gains, position: f64, time: f64) -> (f64, f64) {
        let (interval, rate) = match self.before {
            Some((before, then)) if time > then => (time - then, (position - before) / (time - then)),
            _ => (0.0, 0.0),
        };
        self.before = Some((position, time));
        if !position.is_finite() || !(wanted.position.is_finite() || wanted.rate.is_finite()) {
            self.integral = 0.0;
            return (0.0, rate);
        }
        let correction = if wanted.position.is_finite() { gains.position * (wanted.position - position) } else { 0.0 };
        let wanted_rate = correction + if wanted.rate.is_finite() { wanted.rate } else { 0.0 };
        let lever = self.cylinder.linkage.lever(position);
        let wanted_speed = lever * wanted_rate;
        let full = self.full_speed[usize::from(wanted_speed < 0.0)];
        let share = (wanted_speed / full).clamp(-1.0, 1.0);
        let missing = share - lever * rate / full;
        // Anti-windup: the valve cannot open beyond its largest area, so the integral must not grow further.
        let integral = self.integral + gains.integral * missing * interval;
        self.integral = integral.clamp(-1.0 - share, 1.0 - share).clamp(-1.0, 1.0);
        ((share + self.integral).clamp(-1.0, 1.0) * self.opening, rate)
    }

    /// Resets the integral when no commands come.
    pub fn rest(&mut self) {
        self.integral = 0.0;
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    const GAINS: Gains = Gains { position: 4.0, integral: 4.0 };

    #[test]
    fn the_opening_is_within_the_valve_and_towards_the_target() {
        let mut law = JointLaw::of(&built_in("zx30u-arm").unwrap()).unwrap().remove(0).unwrap();
        let here = law.cylinder.linkage.joint(0.0);
        let far = Wanted { position: here - 1.0, rate: f64::NAN };
        for step in 0..1000 {
            let (opening, _) = law.step(far, GAINS, here, 0.01 * f64::from(step));
            // The arm's angle decreases as its cylinder extends.
            assert!(opening > 0.0 && opening <= law.opening);
        }
        let (opening, _) = law.step(Wanted { position: f64::NAN, rate: f64::NAN }, GAINS, here, 11.0);
        assert_eq!(opening, 0.0);
    }

    #[test]
    fn a_machine_without_oil_is_refused() {
        assert!(JointLaw::of(&built_in("emps").unwrap()).unwrap().iter().all(Option::is_none));
        assert_eq!(JointLaw::of(&built_in("zx30u-excavator").unwrap()).unwrap().len(), 4);
    }
}
