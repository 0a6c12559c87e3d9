//! Small things that every real machine does and no model has. They are always there, also where nothing is hidden.

use std::f64::consts::TAU;

use super::Reversal;

/// Sizes of the unmodelled extras; chosen so that each moves a signal by no more than a few times its noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extras {
    /// Pump flow ripple as a share of the flow.
    pub ripple: f64,
    /// Its frequency, Hz.
    pub ripple_frequency: f64,
    /// Share by which viscous damping falls per second as the oil warms.
    pub damping_drift: f64,
    /// Compliance of a stub of hose on each chamber, m³/Pa.
    pub hose_compliance: f64,
    /// Oil temperature at the start, degC.
    pub temperature: f64,
    /// Its rise, K/s.
    pub warming: f64,
    /// How friction turns round.
    pub reversal: Reversal,
}

impl Extras {
    /// None of them.
    pub fn none() -> Self {
        Extras {
            ripple: 0.0,
            ripple_frequency: 0.0,
            damping_drift: 0.0,
            hose_compliance: 0.0,
            temperature: 27.0,
            warming: 0.0,
            reversal: Reversal::usual(),
        }
    }

    /// As on every machine of the benchmark: 0.3 % of ripple at 187 Hz (nine pistons at 1250 rev/min) is about 0.5 kPa in the
    /// pump line; 0.4 K of warming in 38 s thins the oil by 1 % (about 13 N at 0.1 m/s, 3 kPa); a stub of hose of 10 cm³
    /// with an effective bulk modulus of 400 MPa is 2 % of a chamber's compliance.
    pub fn usual() -> Self {
        Extras {
            ripple: 3e-3,
            ripple_frequency: 187.0,
            damping_drift: 0.01 / 38.0,
            hose_compliance: 1e-5 / 4e8,
            temperature: 27.0,
            warming: 0.4 / 38.0,
            reversal: Reversal::usual(),
        }
    }

    /// Factor on the pump flow at a time in s.
    pub fn pump_factor(&self, time: f64) -> f64 {
        if self.ripple == 0.0 { 1.0 } else { 1.0 + self.ripple * (TAU * self.ripple_frequency * time).sin() }
    }

    /// Factor on viscous damping at a time in s.
    pub fn damping_factor(&self, time: f64) -> f64 {
        1.0 - self.damping_drift * time
    }
}
