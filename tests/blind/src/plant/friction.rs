//! Forces between piston, barrel and rod, and effects on them.

use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};

use super::geometry::STROKE;

/// Stiffness of the cylinder's ends, N/m: 0.1 mm under full pump pressure.
const END_STIFFNESS: f64 = 5e7;
/// Damping factor of the ends, s/m.
const END_DAMPING: f64 = 5.0;

/// Effects on the piston.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Friction {
    /// Quadratic loss zeta, N s²/m².
    pub hose_loss: f64,
    /// Extra friction at standstill Fs, N.
    pub stribeck_force: f64,
    /// Speed vs at which it has fallen to 37 %, m/s.
    pub stribeck_speed: f64,
    /// Seal friction per sum of chamber pressures, N/Pa.
    pub pressure_coefficient: f64,
    /// Extra Coulomb friction while extending, N.
    pub extra_extending: f64,
    /// Extra Coulomb friction while retracting, N.
    pub extra_retracting: f64,
    /// Length of the cushions at both ends, m.
    pub cushion_length: f64,
    /// Damping of a cushion that is fully entered, N s/m.
    pub cushion_damping: f64,
}

/// How friction turns round where the piston does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reversal {
    /// Speed over which the sign of the velocity changes, m/s.
    pub speed: f64,
    /// How it does.
    pub law: ReversalLaw,
}

/// How a sign changes, every one with slope one at zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReversalLaw {
    /// Hyperbolic tangent, as the model's.
    Tangent,
    /// `x / sqrt(1 + x^2)`, which arrives late.
    Root,
    /// Straight, with corners.
    Straight,
}

impl Reversal {
    /// As the model's.
    pub fn usual() -> Self {
        Reversal { speed: 1e-3, law: ReversalLaw::Tangent }
    }

    /// A machine's own: half to five times as wide as the model's, by one of three laws.
    pub fn draw(generator: &mut impl Rng) -> Self {
        let laws = [ReversalLaw::Tangent, ReversalLaw::Root, ReversalLaw::Straight];
        let speed = 0.5e-3 * 10.0_f64.powf(generator.random::<f64>());
        Reversal { speed, law: laws.choose(generator).copied().unwrap_or(ReversalLaw::Tangent) }
    }

    /// `sgn(v)`.
    pub fn direction(&self, velocity: f64) -> f64 {
        let ratio = velocity / self.speed;
        match self.law {
            ReversalLaw::Tangent => ratio.tanh(),
            ReversalLaw::Root => ratio / ratio.hypot(1.0),
            ReversalLaw::Straight => ratio.clamp(-1.0, 1.0),
        }
    }
}

impl Friction {
    /// Force of all the effects on the piston, N, + = extends; `direction` is that of the motion, rounded.
    pub fn force(
        &self,
        displacement: f64,
        velocity: f64,
        direction: f64,
        [cap_pressure, rod_pressure]: [f64; 2],
    ) -> f64 {
        let mut level = if velocity > 0.0 { self.extra_extending } else { self.extra_retracting };
        if self.stribeck_force > 0.0 {
            let relative = velocity / self.stribeck_speed;
            level += self.stribeck_force * (-relative * relative).exp();
        }
        level += self.pressure_coefficient * (cap_pressure.max(0.0) + rod_pressure.max(0.0));
        let mut force = -self.hose_loss * velocity * velocity.abs();
        if level > 0.0 {
            force -= level * direction;
        }
        force + self.cushion(displacement, velocity)
    }

    /// The cushion brakes only on the way in; on the way out a check valve lets oil past.
    fn cushion(&self, displacement: f64, velocity: f64) -> f64 {
        if self.cushion_damping == 0.0 || displacement * velocity <= 0.0 {
            return 0.0;
        }
        let entered = displacement.abs() - (STROKE / 2.0 - self.cushion_length);
        -self.cushion_damping * (entered / self.cushion_length).clamp(0.0, 1.0) * velocity
    }
}

/// Force of the cylinder's ends, N: stiff one-sided contact with damping, never pulling.
pub fn end_stop(displacement: f64, velocity: f64) -> f64 {
    let side = displacement.signum();
    let depth = displacement.abs() - STROKE / 2.0;
    if depth <= 0.0 {
        return 0.0;
    }
    -side * (END_STIFFNESS * depth * (1.0 + END_DAMPING * velocity * side)).max(0.0)
}
