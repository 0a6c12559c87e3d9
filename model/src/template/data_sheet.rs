//! Data of a machine that are known before measurements.

/// A data sheet. All values are in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct DataSheet {
    /// Name of the machine, a word.
    pub name: String,
    /// Name of the cylinder or motor, a word.
    pub part: String,
    /// The drive.
    pub drive: DriveKind,
    /// The driven actuator.
    pub actuator: Actuator,
    /// The load.
    pub load: Load,
    /// Input at which the valve is fully open; only for drives with a valve.
    pub command: Option<ValveCommand>,
    /// Flow of the fully open valve; estimated if omitted.
    pub rated: Option<RatedFlow>,
    /// Pressure of the supply, Pa: of a valve on constant pressure, of the charge line of a pump drive, or the cut-off of a
    /// load-sensing pump. A pump drive without it takes what it lacks from the tank.
    pub supply_pressure: Option<f64>,
    /// Largest flow of the pump, m³/s. Without it, that of an open-centre valve or of a pump drive is estimated, and a load-sensing pump
    /// counts as a supply of constant pressure.
    pub pump_flow: Option<f64>,
    /// Oil volumes between valve and cap side and between valve and rod side, m³: hoses and ports. A tenth of the stroke's volume
    /// if omitted.
    pub dead_volumes: Option<[f64; 2]>,
    /// Bulk modulus of the oil, Pa.
    pub bulk_modulus: Option<f64>,
    /// Pressure that a load-sensing pump keeps above the highest load, Pa.
    pub load_sensing_margin: Option<f64>,
    /// Pressure drop that a compensator leaves to the metering edge, Pa.
    pub metering_drop: Option<f64>,
}

/// The drive of a cylinder or motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveKind {
    /// A valve on a supply of constant pressure.
    Valve,
    /// An open-centre valve on a pump of constant flow.
    OpenCentre,
    /// A valve with a pressure compensator on a load-sensing pump.
    LoadSensing,
    /// A separate pump, in a closed circuit.
    Pump,
    /// A measured force.
    Force,
    /// A testing machine that imposes the rod's motion, whatever the force.
    ImposedMotion,
}

/// The driven actuator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Actuator {
    /// A cylinder.
    Cylinder {
        /// Diameter of the piston, m.
        bore: f64,
        /// Diameter of the rod, m.
        rod: f64,
        /// Stroke, m.
        stroke: f64,
        /// How it is built.
        kind: CylinderKind,
    },
    /// A hydraulic motor.
    Motor {
        /// Volume per angle of the shaft, m³/rad.
        displacement: f64,
        /// Shaft turns per turn of the load; angle per travel in rad/m for a load that moves along a line.
        ratio: f64,
    },
}

/// How a cylinder is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CylinderKind {
    /// A rod on one side.
    Differential,
    /// A rod through both sides: equal areas.
    DoubleRod,
    /// Oil on the cap side only; the load brings it back.
    SingleActing,
}

/// The load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// A mass along a line.
    Mass {
        /// Mass with piston and rod, kg; estimated if omitted.
        mass: Option<f64>,
        /// Sine of the slope: 1 where extension lifts it, 0 on the level.
        slope: f64,
    },
    /// A link that turns about a joint, driven by a cylinder pinned across it.
    Link {
        /// Distance from the joint to the cylinder's foot pin, m.
        foot_arm: f64,
        /// Distance from the joint to the rod's pin, m.
        rod_arm: f64,
        /// Distance from pin to pin at mid-stroke, m.
        pin_length: f64,
        /// Moment of inertia about the joint, kg m².
        inertia: f64,
        /// Mass times distance of its centre of gravity from the joint, kg m.
        gravity_moment: f64,
        /// Whether extension lowers the joint's angle.
        mirrored: bool,
    },
    /// An inertia that turns about a fixed axis.
    Rotor {
        /// Moment of inertia on the load's side of the gear, kg m².
        inertia: f64,
        /// Torque of a hanging load on the same side, N m.
        torque: f64,
    },
}

/// Input at which a valve is fully open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ValveCommand {
    /// Orifice area, m².
    Area(f64),
    /// Voltage, V.
    Volts(f64),
    /// Current, A.
    Amperes(f64),
    /// A pure number: 1, or 100 for per cent.
    Share(f64),
}

impl ValveCommand {
    /// The number, in its unit.
    pub fn value(self) -> f64 {
        match self {
            ValveCommand::Area(value)
            | ValveCommand::Volts(value)
            | ValveCommand::Amperes(value)
            | ValveCommand::Share(value) => value,
        }
    }
}

/// Flow of a fully open valve across one of its edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RatedFlow {
    /// Flow, m³/s.
    pub flow: f64,
    /// Pressure drop over one edge, Pa.
    pub drop: f64,
}

/// A missing value that cannot be estimated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("a machine with this drive needs {what}")]
#[non_exhaustive]
pub struct MissingFromDataSheet {
    /// Description of the missing value.
    pub what: &'static str,
}

impl DataSheet {
    /// Working pressure of the machine, Pa.
    pub(super) fn working_pressure(&self) -> f64 {
        match self.drive {
            // The charge pressure of a closed circuit is unrelated to the pump's working pressure.
            DriveKind::Pump => USUAL_PRESSURE,
            _ => self.supply_pressure.unwrap_or(USUAL_PRESSURE),
        }
    }

    /// Areas of cap and rod side, m² (m³/rad for a motor).
    pub(super) fn areas(&self) -> [f64; 2] {
        match self.actuator {
            Actuator::Cylinder { bore, rod, kind, .. } => {
                let [piston, stem] = [bore, rod].map(|diameter| std::f64::consts::PI / 4.0 * diameter * diameter);
                match kind {
                    CylinderKind::DoubleRod => [piston - stem; 2],
                    CylinderKind::Differential | CylinderKind::SingleActing => [piston, piston - stem],
                }
            }
            Actuator::Motor { displacement, .. } => [displacement; 2],
        }
    }

    /// Largest flow of the pump, m³/s: that of the sheet, else the usual flow with a reserve, and the source of the number.
    pub(super) fn largest_pump_flow(&self) -> (f64, &'static str) {
        const RESERVE: f64 = 1.5;
        self.pump_flow.map_or(
            (RESERVE * self.usual_flow(), "estimated: a full stroke in two seconds, and half as much again"),
            |flow| (flow, "data sheet"),
        )
    }

    /// What the sheet lacks and the model file estimates.
    pub fn estimated(&self) -> Vec<&'static str> {
        let has_pump = matches!(self.drive, DriveKind::OpenCentre | DriveKind::Pump);
        let lacks_mass = matches!(self.load, Load::Mass { mass: None, .. });
        let has_oil = !matches!(self.drive, DriveKind::Force | DriveKind::ImposedMotion);
        [
            (has_oil && self.dead_volumes.is_none()).then_some("the oil in ports and hoses"),
            lacks_mass.then_some("the mass"),
            (has_pump && self.pump_flow.is_none()).then_some("the flow of the pump"),
            (self.drive == DriveKind::Pump && self.supply_pressure.is_none()).then_some("the charge pressure"),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Rated flow of the actuator, m³/s.
    pub(super) fn usual_flow(&self) -> f64 {
        let by_speed = match self.actuator {
            Actuator::Cylinder { stroke, .. } => stroke / STROKE_TIME,
            Actuator::Motor { .. } => MOTOR_SPEED,
        };
        self.pump_flow.or(self.rated.map(|rated| rated.flow)).unwrap_or(by_speed * self.areas()[0])
    }
}

/// A usual working pressure of mobile and bench hydraulics, Pa.
const USUAL_PRESSURE: f64 = 1e7;

/// Usual time of a full stroke, s.
const STROKE_TIME: f64 = 2.0;

/// Usual speed of a motor's shaft, rad/s: 500 revolutions per minute.
const MOTOR_SPEED: f64 = 50.0;
