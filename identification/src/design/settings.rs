//! Settings of a design.

use excavator_model::machine::Machine;

use super::{DesignError, Limits, Sensors};
use crate::fit::FitSettings;

/// Settings of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignSettings {
    /// Longest profile, s.
    pub duration: f64,
    /// Limits of the manoeuvres.
    pub limits: Limits,
    /// What the instruments measure, and their noise.
    pub sensors: Sensors,
    /// Fits of the trial run.
    pub fit: FitSettings,
    /// Seed for the noise of the trial run.
    pub seed: u64,
}

/// Shortest profile, s: one manoeuvre with the transfers to it and back.
const SHORTEST: f64 = 15.0;
/// Longest profile, s.
const LONGEST: f64 = 600.0;

impl DesignSettings {
    /// 60 s with the usual limits and sensors of a machine.
    pub fn usual(machine: &Machine) -> Self {
        DesignSettings {
            duration: 60.0,
            limits: Limits::default(),
            sensors: Sensors::usual(machine),
            fit: FitSettings::default(),
            seed: 1,
        }
    }

    pub(super) fn check(&self) -> Result<(), DesignError> {
        if (SHORTEST..=LONGEST).contains(&self.duration) {
            return Ok(());
        }
        Err(DesignError::Duration { found: self.duration, least: SHORTEST, most: LONGEST })
    }
}
