//! Limits of a manoeuvre, and their violations.

use excavator_model::display::pressure_text;
use excavator_model::machine::Machine;

/// Limits of a manoeuvre. There is no lower pressure limit: in ordinary work a chamber that is pulled faster than the valve fills
/// it reaches the vapour pressure, and the models include make-up flow for that case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Share of the stroke kept free at each end. Rivals drift differently, and the machine even more so.
    pub stroke_margin: f64,
    /// Highest pressure, Pa (gauge).
    pub highest_pressure: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { stroke_margin: 0.08, highest_pressure: 2e7 }
    }
}

/// Largest and smallest values during a simulation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Extremes {
    /// Piston displacement of each cylinder, m.
    pub displacement: Vec<(f64, f64)>,
    /// Highest pressure of all chambers and the pump line, Pa.
    pub highest_pressure: f64,
}

/// Why a manoeuvre is outside the limits.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Violation {
    /// Too near an end of the stroke.
    #[error("the {cylinder} cylinder comes to {found:.3} m; the stroke less its margin ends at {limit:.3} m")]
    Stroke {
        /// The cylinder.
        cylinder: String,
        /// Displacement, m.
        found: f64,
        /// Limit, m.
        limit: f64,
    },
    /// A pressure is too high.
    #[error("a pressure comes to {}; the limit is {}", pressure_text(*found), pressure_text(*limit))]
    Pressure {
        /// Pressure, Pa.
        found: f64,
        /// Limit, Pa.
        limit: f64,
    },
    /// The cylinder does not reach a place in time.
    #[error("the {cylinder} cylinder does not come from {from:.3} m to {to:.3} m within {within} s")]
    Unreachable {
        /// The cylinder.
        cylinder: String,
        /// Displacement, m.
        from: f64,
        /// Displacement wanted, m.
        to: f64,
        /// Time allowed, s.
        within: f64,
    },
    /// The simulation ended early.
    #[error("a rival cannot be simulated: {0}")]
    Simulation(String),
}

impl Extremes {
    pub fn none(cylinders: usize) -> Self {
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        Extremes { displacement: vec![nothing; cylinders], highest_pressure: f64::NEG_INFINITY }
    }

    pub fn see_displacement(&mut self, cylinder: usize, value: f64) {
        let (low, high) = &mut self.displacement[cylinder];
        (*low, *high) = (low.min(value), high.max(value));
    }

    pub fn see_pressure(&mut self, value: f64) {
        self.highest_pressure = self.highest_pressure.max(value);
    }
}

impl Limits {
    /// Largest distance from mid-stroke, m.
    pub fn half_way(&self, stroke: f64) -> f64 {
        stroke * (0.5 - self.stroke_margin)
    }

    /// Checks that a simulation stayed inside the limits.
    ///
    /// # Errors
    /// The first [`Violation`].
    pub(super) fn check(&self, machine: &Machine, extremes: &Extremes) -> Result<(), Violation> {
        for (cylinder, &(low, high)) in machine.cylinders.iter().zip(&extremes.displacement) {
            let limit = self.half_way(cylinder.stroke);
            if let Some((found, limit)) =
                [(low, -limit), (high, limit)].into_iter().find(|(found, _)| found.abs() > limit)
            {
                return Err(Violation::Stroke { cylinder: cylinder.name.clone(), found, limit });
            }
        }
        let high = extremes.highest_pressure;
        if high > self.highest_pressure {
            return Err(Violation::Pressure { found: high, limit: self.highest_pressure });
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    #[test]
    fn each_limit_is_told_with_its_number() {
        let machine = built_in("zx30u-arm").unwrap().machine;
        let limits = Limits::default();
        let inside = Extremes { displacement: vec![(-0.2, 0.25)], highest_pressure: 5e6 };
        assert_eq!(limits.check(&machine, &inside), Ok(()));

        let low = Extremes { displacement: vec![(-0.26, 0.1)], ..inside.clone() };
        let complaint = limits.check(&machine, &low).unwrap_err().to_string();
        assert!(complaint.contains("-0.260 m") && complaint.contains("-0.252 m"), "{complaint}");
        let high = Extremes { highest_pressure: 2.1e7, ..inside };
        assert_eq!(limits.check(&machine, &high), Err(Violation::Pressure { found: 2.1e7, limit: 2e7 }));
    }
}
