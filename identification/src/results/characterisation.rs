//! Result of `characterise`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{DeadZone, Friction, Gain, Outcome, ValveLeakage, finite};
use crate::characterisation::{self, DriveCurve, Edge, Refusal};

/// Valves and friction, read off recordings without a simulation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Characterisation {
    /// The cylinders, in the model's order.
    pub cylinders: Vec<CylinderCharacterisation>,
}

/// What the procedures found of one cylinder. What a recording does not show is refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct CylinderCharacterisation {
    /// Name of the cylinder.
    pub name: String,
    /// Full command of its valve section, m2 for an opening; 1 where the cylinder has no chambers.
    pub maximum_orifice_area: Option<f64>,
    /// Gain by metering edge: `cap_positive`, `rod_positive`, `cap_negative`, `rod_negative`, the chamber and the sign of the opening.
    pub gains: BTreeMap<String, Outcome<Gain>>,
    /// Dead zone by metering edge.
    pub dead_zones: BTreeMap<String, Outcome<DeadZone>>,
    /// Leakage of the closed valve.
    pub valve_leakage: Outcome<ValveLeakage>,
    /// Friction against speed.
    pub friction: Outcome<Friction>,
    /// Flow of the drive against its input, from steady stretches: null, dead zone and gains of a valve, or the losses of a pump.
    pub drive: Outcome<DriveCurve>,
    /// Where the piston meets its stops, m: retracted and extended; `null` where the recordings do not reach one.
    pub stops: [Option<characterisation::Estimate>; 2],
}

impl Characterisation {
    /// Of what the procedures found of every cylinder.
    pub fn of(found: &[characterisation::Characterisation]) -> Self {
        Characterisation { cylinders: found.iter().map(CylinderCharacterisation::of).collect() }
    }
}

impl CylinderCharacterisation {
    fn of(found: &characterisation::Characterisation) -> Self {
        CylinderCharacterisation {
            name: found.cylinder.clone(),
            maximum_orifice_area: finite(found.maximum_orifice_area),
            gains: by_edge(&found.gains, Gain::of),
            dead_zones: by_edge(&found.dead_zones, DeadZone::of),
            valve_leakage: Outcome::of(&found.leakage, ValveLeakage::of),
            friction: Outcome::of(&found.friction, Friction::of),
            drive: Outcome::of(&found.drive, DriveCurve::clone),
            stops: found.stops,
        }
    }
}

fn by_edge<T, R>(found: &[(Edge, Result<T, Refusal>)], of: impl Fn(&T) -> R) -> BTreeMap<String, Outcome<R>> {
    found.iter().map(|(edge, one)| (edge.key().to_string(), Outcome::of(one, &of))).collect()
}
