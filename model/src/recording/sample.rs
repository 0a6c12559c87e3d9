//! One instant of a working machine: one row of a recording, before the recording exists.

/// State of a machine at one instant, measured or simulated; `NaN` = not measured. Units are those of a [`super::Recording`].
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Time of the sample, ns.
    pub nanoseconds: i64,
    /// One entry per cylinder of the machine, in its order.
    pub cylinders: Vec<CylinderSample>,
    /// Pump pressure, Pa.
    pub pump_pressure: f64,
    /// Tank pressure, Pa.
    pub tank_pressure: f64,
    /// Pump flow, m³/s.
    pub pump_flow: f64,
}

/// State of one cylinder at one instant; `NaN` = not measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CylinderSample {
    /// Joint angle, rad.
    pub joint_angle: f64,
    /// Piston displacement, m.
    pub displacement: f64,
    /// Piston velocity, m/s.
    pub velocity: f64,
    /// Cap side pressure, Pa.
    pub cap_pressure: f64,
    /// Rod side pressure, Pa.
    pub rod_pressure: f64,
    /// Spool opening, m²; the command where there is no spool sensor.
    pub orifice_area: f64,
    /// Force on the rod, N.
    pub rod_force: f64,
}

impl CylinderSample {
    /// A cylinder without any measurement.
    pub fn unmeasured() -> Self {
        CylinderSample {
            joint_angle: f64::NAN,
            displacement: f64::NAN,
            velocity: f64::NAN,
            cap_pressure: f64::NAN,
            rod_pressure: f64::NAN,
            orifice_area: f64::NAN,
            rod_force: f64::NAN,
        }
    }
}
