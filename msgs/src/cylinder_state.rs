//! `excavator_msgs/CylinderState`.

use serde::{Deserialize, Serialize};

use crate::Message;

/// One hydraulic cylinder and the valve section that feeds it; `NaN` = not measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CylinderState {
    /// Name of the cylinder: "boom", "arm", "bucket"; unique within one [`ArmState`](crate::ArmState).
    pub name: String,
    /// Angle q of the joint that the cylinder drives, rad.
    pub joint_angle: f64,
    /// Piston displacement s from mid-stroke, m, + = extension.
    pub displacement: f64,
    /// Piston velocity ds/dt, m/s, + = extension.
    pub velocity: f64,
    /// Cap side pressure p+, Pa (gauge).
    pub cap_pressure: f64,
    /// Rod side pressure p-, Pa (gauge).
    pub rod_pressure: f64,
    /// Measured spool opening u, m², + = pump to cap side.
    pub orifice_area: f64,
    /// Force F of the load cell on the rod, N, + = pushes the rod out.
    pub rod_force: f64,
}

impl CylinderState {
    /// A cylinder without measurements. There is no `Default`: zeros would be measurements.
    ///
    /// ```
    /// use excavator_msgs::CylinderState;
    ///
    /// let state = CylinderState { cap_pressure: 12.4e6, ..CylinderState::unmeasured("arm") };
    /// assert!(state.rod_force.is_nan());
    /// ```
    pub fn unmeasured(name: &str) -> Self {
        CylinderState {
            name: name.to_string(),
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

impl Message for CylinderState {
    const TYPE_NAME: &'static str = "excavator_msgs/msg/CylinderState";
}
