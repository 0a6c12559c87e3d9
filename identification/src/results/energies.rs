//! Energies over a stretch of time.

use std::collections::BTreeMap;

use excavator_model::{Model, site_name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::energy;

/// Energies over a stretch of time, by cylinder and by effect; or their standard deviations from cycle to cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Energies {
    /// Time that was accounted for, s; gaps are not.
    pub duration: Option<f64>,
    /// Energy of the pump, J: integral of `b (exp(p/b) - 1) Q`, with pump flow Q, pressure p and bulk modulus b of the pump line.
    pub pump: Option<f64>,
    /// Gain of the pump line's energy, J.
    pub pump_line: Option<f64>,
    /// The cylinders by name.
    pub cylinders: BTreeMap<String, CylinderEnergies>,
    /// Effects with power of their own.
    pub effects: Vec<EffectEnergies>,
}

/// What one cylinder and its joint took in and gave away.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct CylinderEnergies {
    /// Supplied through the valve, or by the measured force on the rod, J.
    pub supplied: Option<f64>,
    /// Gain of kinetic energy, J.
    pub kinetic: Option<f64>,
    /// Gain of potential energy, J.
    pub potential: Option<f64>,
    /// Gain of the cap side's compression energy, J.
    pub cap_internal: Option<f64>,
    /// Gain of the rod side's compression energy, J.
    pub rod_internal: Option<f64>,
    /// Lost in the valve section between pump line, chambers and tank, J.
    pub metering_loss: Option<f64>,
    /// Gain of all stored energy, J; absent from standard deviations, as what follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stored: Option<f64>,
    /// Given by all effects other than its valve, J; negative: turned into heat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dissipation: Option<f64>,
    /// Stored without the model saying from where, J; negative: it went missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual: Option<f64>,
}

/// Energy of one effect; positive where it gave energy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct EffectEnergies {
    /// Name in the catalogue.
    pub effect: String,
    /// Name of its place: a cylinder, `pump` or `machine`.
    pub at: String,
    /// Given to links and chambers, J.
    pub into_cylinders: Option<f64>,
    /// Given to the pump line, J.
    pub into_pump_line: Option<f64>,
}

impl Energies {
    /// Sums and differences of others only where `derived`: those of standard deviations mean nothing.
    pub(super) fn of(model: &Model, totals: &energy::Totals, derived: bool) -> Self {
        let cylinders = model.machine.cylinders.iter().zip(&totals.cylinders).enumerate();
        let cylinders = cylinders.map(|(index, (cylinder, own))| {
            let energies = CylinderEnergies {
                supplied: finite(own.supplied),
                kinetic: finite(own.kinetic),
                potential: finite(own.potential),
                cap_internal: finite(own.cap_internal),
                rod_internal: finite(own.rod_internal),
                metering_loss: finite(own.metering_loss),
                // A number that is none is null, and not absent.
                stored: derived.then(|| own.stored()),
                dissipation: derived.then(|| totals.dissipation(index)),
                residual: derived.then(|| totals.residual(index)),
            };
            (cylinder.name.clone(), energies)
        });
        let with_power = totals.effects.iter().filter(|effect| effect.has_power);
        let effects = with_power.map(|effect| EffectEnergies {
            effect: effect.effect.to_string(),
            at: site_name(&model.machine, effect.site).to_string(),
            into_cylinders: finite(effect.into_cylinders),
            into_pump_line: finite(effect.into_pump_line),
        });
        Energies {
            duration: finite(totals.duration),
            pump: finite(totals.pump),
            pump_line: finite(totals.pump_line),
            cylinders: cylinders.collect(),
            effects: effects.collect(),
        }
    }
}
