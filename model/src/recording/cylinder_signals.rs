//! The signals of one hydraulic cylinder and the valve section that feeds it.

/// Signals of one cylinder, one value per sample of the recording's clock; `NaN` = not measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CylinderSignals {
    /// Name of the cylinder: "boom", "arm", "bucket", "load"; unique within one recording.
    pub name: String,
    /// Angle q of the joint that the cylinder drives, rad.
    pub joint_angle: Vec<f64>,
    /// Piston displacement s from mid-stroke, m, + = extension.
    pub displacement: Vec<f64>,
    /// Piston velocity ds/dt, m/s.
    pub velocity: Vec<f64>,
    /// Cap side pressure p+, Pa (gauge).
    pub cap_pressure: Vec<f64>,
    /// Rod side pressure p-, Pa (gauge).
    pub rod_pressure: Vec<f64>,
    /// Measured spool opening u, m², + = pump to cap side.
    pub orifice_area: Vec<f64>,
    /// Force F of the load cell on the rod, N, + = pushes the rod out.
    pub rod_force: Vec<f64>,
    /// Commanded orifice area r, m², held from the last command until the next; `NaN` before the first.
    pub orifice_command: Vec<f64>,
}

impl CylinderSignals {
    /// Signals of a cylinder without any measurement.
    pub fn unmeasured(name: &str, samples: usize) -> Self {
        let nothing = vec![f64::NAN; samples];
        CylinderSignals {
            name: name.to_string(),
            joint_angle: nothing.clone(),
            displacement: nothing.clone(),
            velocity: nothing.clone(),
            cap_pressure: nothing.clone(),
            rod_pressure: nothing.clone(),
            orifice_area: nothing.clone(),
            rod_force: nothing.clone(),
            orifice_command: nothing,
        }
    }

    /// Applies `pick` to every signal.
    pub(super) fn with_columns(&self, pick: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        CylinderSignals {
            name: self.name.clone(),
            joint_angle: pick(&self.joint_angle),
            displacement: pick(&self.displacement),
            velocity: pick(&self.velocity),
            cap_pressure: pick(&self.cap_pressure),
            rod_pressure: pick(&self.rod_pressure),
            orifice_area: pick(&self.orifice_area),
            rod_force: pick(&self.rod_force),
            orifice_command: pick(&self.orifice_command),
        }
    }

    /// Every signal, in message order.
    pub fn columns_mut(&mut self) -> [&mut Vec<f64>; 8] {
        [
            &mut self.joint_angle,
            &mut self.displacement,
            &mut self.velocity,
            &mut self.cap_pressure,
            &mut self.rod_pressure,
            &mut self.orifice_area,
            &mut self.rod_force,
            &mut self.orifice_command,
        ]
    }

    /// Every signal with its name, in message order.
    pub fn signals(&self) -> [(&'static str, &[f64]); 8] {
        [
            ("joint_angle", &self.joint_angle),
            ("displacement", &self.displacement),
            ("velocity", &self.velocity),
            ("cap_pressure", &self.cap_pressure),
            ("rod_pressure", &self.rod_pressure),
            ("orifice_area", &self.orifice_area),
            ("rod_force", &self.rod_force),
            ("orifice_command", &self.orifice_command),
        ]
    }
}
