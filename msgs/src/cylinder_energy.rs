//! `excavator_msgs/CylinderEnergy`.

use serde::{Deserialize, Serialize};

use crate::{EnergyTerm, Message};

/// Port-Hamiltonian energy balance of one cylinder and the link that it drives (Arai et al. 2021, Eq. 9-12).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CylinderEnergy {
    /// Name of the cylinder.
    pub name: String,
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Potential energy in the field of gravity, J.
    pub potential: f64,
    /// Compression energy of the oil on the cap side, J.
    pub cap_internal: f64,
    /// Compression energy of the oil on the rod side, J.
    pub rod_internal: f64,
    /// Hamiltonian, the sum of the four above, J.
    pub hamiltonian: f64,
    /// Rate of the Hamiltonian, W, differentiated from the measured state ("experimental").
    pub hamiltonian_rate: f64,
    /// Dissipated power, W, the sum of `terms`; not above 0 for a passive model.
    pub dissipation: f64,
    /// Supply rate through the valve, W.
    pub supply: f64,
    /// `hamiltonian_rate - (dissipation + supply)`, W.
    pub balance_residual: f64,
    /// Power of each effect.
    pub terms: Vec<EnergyTerm>,
}

impl Message for CylinderEnergy {
    const TYPE_NAME: &'static str = "excavator_msgs/msg/CylinderEnergy";
}
