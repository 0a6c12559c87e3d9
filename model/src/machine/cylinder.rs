//! One hydraulic cylinder or motor with its drive.

use super::{CommandUnit, Linkage};
use crate::scalar::Scalar;

/// A cylinder or motor, its linkage to the joint, and the known data of its chambers.
///
/// A motor is a cylinder without ends. Its displacement is the shaft angle in rad, its force is the shaft torque in N m, its
/// areas are its displacement volume in m³/rad, and its chamber volumes are constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Cylinder {
    /// "boom", "arm", "bucket", "load".
    pub name: String,
    /// How the piston drives the joint.
    pub linkage: Linkage,
    /// Stroke L in m; infinite for a motor. The sensor counts from mid-stroke.
    pub stroke: f64,
    /// Where the piston meets its stops, m from mid-stroke: retracted, extended. ±L/2 unless the stops are elsewhere.
    pub ends: [f64; 2],
    /// Oil chambers; `None` for a drive whose force is measured instead.
    pub chambers: Option<Chambers>,
    /// An external machine imposes the rod's motion, whatever the force; only without chambers.
    pub imposed_motion: Option<ImposedMotion>,
}

/// Share of the stroke within which a piston is at its end: more than a stop yields and a sensor is off.
const AT_AN_END: f64 = 0.02;

/// Share of the stroke within which a piston may touch its stop, whose force is then uncertain: the stop is stiff.
const AT_A_STOP: f64 = 0.005;

impl Cylinder {
    /// Whether it is a motor.
    pub fn is_motor(&self) -> bool {
        self.stroke.is_infinite()
    }

    /// Whether a piston at this displacement (m) is at one of its ends; never for a motor.
    pub fn is_at_an_end(&self, displacement: f64) -> bool {
        self.is_near_an_end(displacement, AT_AN_END)
    }

    /// Whether a piston at this displacement (m) may touch one of its stops; never for a motor.
    pub fn is_at_a_stop(&self, displacement: f64) -> bool {
        self.is_near_an_end(displacement, AT_A_STOP)
    }

    /// Whether a piston at this displacement (m) is within `share` of the stroke from one of its ends; never for a motor.
    pub fn is_near_an_end(&self, displacement: f64, share: f64) -> bool {
        let [retracted, extended] = self.ends;
        let near = share * self.stroke;
        displacement <= retracted + near || displacement >= extended - near
    }

    /// Usual travel, m: the stroke. For a motor two turns of the shaft, rad.
    pub fn usual_travel(&self) -> f64 {
        if self.is_motor() { 4.0 * std::f64::consts::PI } else { self.stroke }
    }
}

/// A rod moved by a testing machine: displacement and chamber pressures are inputs, the force on the rod is the output.
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

/// Known constants of the two oil chambers and of the drive that feeds them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chambers {
    /// Piston area on the cap side A+, m² (m³/rad for a motor, at port A).
    pub cap_area: f64,
    /// Piston area on the rod side A-, m² (m³/rad for a motor, at port B).
    pub rod_area: f64,
    /// Volume of pipes and ports on the cap side V+min, m³; for a motor the whole volume.
    pub cap_dead_volume: f64,
    /// Volume of pipes and ports on the rod side V-min, m³.
    pub rod_dead_volume: f64,
    /// The drive that feeds them.
    pub drive: Drive,
}

/// The drive that feeds the chambers of a cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// A valve section on the machine's supply.
    Valve {
        /// Its input u when fully open, umax: the largest orifice area in m², or the command in its own unit.
        full_command: f64,
        /// Unit of that input.
        unit: CommandUnit,
    },
    /// A separate pump between both chambers: a closed circuit. Its input u is the lossless flow in m³/s: speed times
    /// displacement.
    Pump {
        /// Largest such flow, m³/s.
        full_flow: f64,
    },
}

impl Drive {
    /// Largest input umax, in the unit of the input.
    pub fn full_command(&self) -> f64 {
        match *self {
            Drive::Valve { full_command, .. } => full_command,
            Drive::Pump { full_flow } => full_flow,
        }
    }

    /// Unit of the input.
    pub fn command_unit(&self) -> CommandUnit {
        match *self {
            Drive::Valve { unit, .. } => unit,
            Drive::Pump { .. } => CommandUnit::CubicMetrePerSecond,
        }
    }
}

impl Chambers {
    /// Largest input umax of the drive, m² for a valve with a known orifice area.
    pub fn full_command(&self) -> f64 {
        self.drive.full_command()
    }

    /// Force of both pressures on the piston, N; for a motor the torque on its shaft, N m.
    pub fn pressure_force<T: Scalar>(&self, cap_pressure: T, rod_pressure: T) -> T {
        cap_pressure * self.cap_area - rod_pressure * self.rod_area
    }

    /// Cap side volume V+ = V+min + (L/2 + s) A+ in m³, \[A\] Eq. 1. It is constant for an infinite stroke.
    pub fn cap_volume<T: Scalar>(&self, stroke: f64, displacement: T) -> T {
        if stroke.is_infinite() {
            return T::from(self.cap_dead_volume);
        }
        (displacement + stroke / 2.0) * self.cap_area + self.cap_dead_volume
    }

    /// Rod side volume V- = V-min + (L/2 - s) A- in m³, \[A\] Eq. 1. It is constant for an infinite stroke.
    pub fn rod_volume<T: Scalar>(&self, stroke: f64, displacement: T) -> T {
        if stroke.is_infinite() {
            return T::from(self.rod_dead_volume);
        }
        (-displacement + stroke / 2.0) * self.rod_area + self.rod_dead_volume
    }
}
