//! What goes into the monitor and what comes out.

/// One measured state; `NaN` = not measured.
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

/// The measured state of one cylinder; `NaN` = not measured.
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
    /// A cylinder of which nothing is measured.
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

/// The energy balance at one measured state, \[A\] Eq. 9-12; `NaN` where a signal is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    /// Time of the state, ns.
    pub nanoseconds: i64,
    /// One entry per cylinder of the machine.
    pub cylinders: Vec<CylinderBalance>,
    /// Power of the pump, W.
    pub pump_power: f64,
    /// Power lost through bypass, relief valve and pump leakage, W.
    pub bypass_loss: f64,
    /// Power lost in the valve sections, W.
    pub metering_loss: f64,
}

/// The energy balance of one cylinder and its link. In a chain of links the residual of one cylinder also holds what
/// the links pass on to each other; in the sum over all cylinders that cancels.
#[derive(Debug, Clone, PartialEq)]
pub struct CylinderBalance {
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Potential energy, J.
    pub potential: f64,
    /// Compression energy of the cap side's oil, J.
    pub cap_internal: f64,
    /// Compression energy of the rod side's oil, J.
    pub rod_internal: f64,
    /// Rate of the sum of the four, from the measured states, W.
    pub hamiltonian_rate: f64,
    /// Power supplied through the valve, or by the measured force on the rod, W.
    pub supply: f64,
    /// Power of each effect that does not store, W.
    pub terms: Vec<EffectTerm>,
}

/// Power of one effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffectTerm {
    /// Name in the catalogue.
    pub effect: &'static str,
    /// W; negative = taken out of the stored energy.
    pub power: f64,
}

impl CylinderBalance {
    /// Energy stored, J.
    pub fn hamiltonian(&self) -> f64 {
        self.kinetic + self.potential + self.cap_internal + self.rod_internal
    }

    /// Sum of the effects' powers, W.
    pub fn dissipation(&self) -> f64 {
        self.terms.iter().map(|term| term.power).sum()
    }

    /// `hamiltonian_rate - (dissipation + supply)`, W: what the model does not explain.
    pub fn residual(&self) -> f64 {
        self.hamiltonian_rate - (self.dissipation() + self.supply)
    }
}
