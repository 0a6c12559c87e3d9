//! Output of the energy monitor.

use crate::effects::Text;

/// The energy balance at one measured state, \[A\] Eq. 9-12; `NaN` where a signal is missing.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Balance {
    /// Time of the state, ns.
    pub nanoseconds: i64,
    /// One entry per cylinder of the machine.
    pub cylinders: Vec<CylinderBalance>,
    /// Power of the pump `e(pp) Qp`, W, as in [`Ledger`](crate::energy::Ledger).
    pub pump_power: f64,
    /// Power lost through bypass, relief valve and pump leakage, W.
    pub bypass_loss: f64,
    /// Power lost in the valve sections, W.
    pub metering_loss: f64,
}

/// The energy balance of one cylinder and its link. In a chain of links the residual of one cylinder also contains
/// the energy exchanged between links; it cancels in the sum over all cylinders.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
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
    /// Power of each effect that does not only store energy, W.
    pub terms: Vec<EffectTerm>,
}

/// Power of one effect.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct EffectTerm {
    /// Name in the catalogue.
    pub effect: Text,
    /// W; negative = reduces the stored energy.
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

    /// `hamiltonian_rate - (dissipation + supply)`, W: the part that the model does not explain.
    pub fn residual(&self) -> f64 {
        self.hamiltonian_rate - (self.dissipation() + self.supply)
    }
}
