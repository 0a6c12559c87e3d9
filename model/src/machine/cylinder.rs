//! One hydraulic cylinder and its valve section.

use super::Linkage;
use crate::scalar::Scalar;

/// A cylinder, its linkage to the joint, and what is known of its chambers.
#[derive(Debug, Clone, PartialEq)]
pub struct Cylinder {
    /// "boom", "arm", "bucket", "load".
    pub name: String,
    /// How the piston drives the joint.
    pub linkage: Linkage,
    /// Stroke L in m; the piston moves within ±L/2.
    pub stroke: f64,
    /// Oil chambers; `None` for a drive whose force is measured instead.
    pub chambers: Option<Chambers>,
    /// The rod is moved from outside, whatever force that takes; only without chambers.
    pub imposed_motion: Option<ImposedMotion>,
}

/// A rod that a testing machine moves: displacement and chamber pressures are inputs, the force on the rod is the output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImposedMotion {
    /// Piston area on the cap side A+, m².
    pub cap_area: f64,
    /// Piston area on the rod side A-, m².
    pub rod_area: f64,
}

impl ImposedMotion {
    /// Force of both pressures on the piston, N.
    pub fn pressure_force<T: Scalar>(&self, cap_pressure: T, rod_pressure: T) -> T {
        cap_pressure * self.cap_area - rod_pressure * self.rod_area
    }
}

/// Known constants of the two oil chambers and of the valve section that feeds them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chambers {
    /// Piston area on the cap side A+, m².
    pub cap_area: f64,
    /// Piston area on the rod side A-, m².
    pub rod_area: f64,
    /// Volume of pipes and ports on the cap side V+min, m³.
    pub cap_dead_volume: f64,
    /// Volume of pipes and ports on the rod side V-min, m³.
    pub rod_dead_volume: f64,
    /// Largest orifice area umax of the valve section, m².
    pub maximum_orifice_area: f64,
}

impl Chambers {
    /// Force of both pressures on the piston, N.
    pub fn pressure_force<T: Scalar>(&self, cap_pressure: T, rod_pressure: T) -> T {
        cap_pressure * self.cap_area - rod_pressure * self.rod_area
    }

    /// Cap side volume V+ = V+min + (L/2 + s) A+ in m³, \[A\] Eq. 1.
    pub fn cap_volume<T: Scalar>(&self, stroke: f64, displacement: T) -> T {
        (displacement + stroke / 2.0) * self.cap_area + self.cap_dead_volume
    }

    /// Rod side volume V- = V-min + (L/2 - s) A- in m³, \[A\] Eq. 1.
    pub fn rod_volume<T: Scalar>(&self, stroke: f64, displacement: T) -> T {
        (-displacement + stroke / 2.0) * self.rod_area + self.rod_dead_volume
    }
}
