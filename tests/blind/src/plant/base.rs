//! Parameters of the nominal model.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// How far a machine's parameters are from the published ones, at most: the spread of the practice recordings.
const SPREAD: f64 = 0.25;

/// The twelve identified parameters of the arm cylinder, \[A\] Table 2, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Base {
    /// J2, kg m².
    pub inertia: f64,
    /// W2, kg m.
    pub gravity_moment: f64,
    /// Fd, N s/m.
    pub viscous_damping: f64,
    /// Fc, N.
    pub coulomb_friction: f64,
    /// b, Pa.
    pub bulk_modulus: f64,
    /// bp, Pa.
    pub pump_bulk_modulus: f64,
    /// Cf+, m/(s sqrt(Pa)).
    pub flow_gain_cap: f64,
    /// Cf-, m/(s sqrt(Pa)).
    pub flow_gain_rod: f64,
    /// Cft, m/(s sqrt(Pa)).
    pub bypass_flow_gain: f64,
    /// Ci, m³/(s Pa).
    pub internal_leakage: f64,
    /// Ce+, m³/(s Pa).
    pub external_leakage_cap: f64,
    /// Ce-, m³/(s Pa).
    pub external_leakage_rod: f64,
}

impl Base {
    /// The published values.
    pub fn published() -> Self {
        Base {
            inertia: 230.0,
            gravity_moment: 190.0,
            viscous_damping: 1.3e4,
            coulomb_friction: 160.0,
            bulk_modulus: 9.6e8,
            pump_bulk_modulus: 6.5e7,
            flow_gain_cap: 4.6e-3,
            flow_gain_rod: 4.0e-3,
            bypass_flow_gain: 1.1e-2,
            internal_leakage: 1.4e-11,
            external_leakage_cap: 4.1e-12,
            external_leakage_rod: 3.0e-12,
        }
    }

    /// A machine of the series: each value within 25 % of the published one, uniformly.
    pub fn draw(generator: &mut ChaCha8Rng) -> Self {
        let mut base = Base::published();
        for value in base.values_mut() {
            *value *= generator.random_range(1.0 - SPREAD..1.0 + SPREAD);
        }
        base
    }

    fn values_mut(&mut self) -> [&mut f64; 12] {
        [
            &mut self.inertia,
            &mut self.gravity_moment,
            &mut self.viscous_damping,
            &mut self.coulomb_friction,
            &mut self.bulk_modulus,
            &mut self.pump_bulk_modulus,
            &mut self.flow_gain_cap,
            &mut self.flow_gain_rod,
            &mut self.bypass_flow_gain,
            &mut self.internal_leakage,
            &mut self.external_leakage_cap,
            &mut self.external_leakage_rod,
        ]
    }

    /// The values under the names that identification reports them by.
    pub fn named(&self) -> [(&'static str, f64); 12] {
        [
            ("arm.inertia", self.inertia),
            ("arm.gravity_moment", self.gravity_moment),
            ("arm.viscous_damping", self.viscous_damping),
            ("arm.coulomb_friction", self.coulomb_friction),
            ("arm.bulk_modulus", self.bulk_modulus),
            ("pump.bulk_modulus", self.pump_bulk_modulus),
            ("arm.flow_gain_cap", self.flow_gain_cap),
            ("arm.flow_gain_rod", self.flow_gain_rod),
            ("pump.bypass_flow_gain", self.bypass_flow_gain),
            ("arm.internal_leakage", self.internal_leakage),
            ("arm.external_leakage_cap", self.external_leakage_cap),
            ("arm.external_leakage_rod", self.external_leakage_rod),
        ]
    }
}
