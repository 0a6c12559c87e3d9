//! Forces between piston, barrel and rod, and effects on them.

use super::geometry::STROKE;

/// Speed over which the sign of the velocity changes, m/s.
const SLIP_SPEED: f64 = 1e-3;
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

/// `sgn(v)`, smooth over 1 mm/s.
pub fn direction(velocity: f64) -> f64 {
    (velocity / SLIP_SPEED).tanh()
}

impl Friction {
    /// Force of all the effects on the piston, N, + = extends.
    pub fn force(&self, displacement: f64, velocity: f64, cap_pressure: f64, rod_pressure: f64) -> f64 {
        let mut level = if velocity > 0.0 { self.extra_extending } else { self.extra_retracting };
        if self.stribeck_force > 0.0 {
            let relative = velocity / self.stribeck_speed;
            level += self.stribeck_force * (-relative * relative).exp();
        }
        level += self.pressure_coefficient * (cap_pressure.max(0.0) + rod_pressure.max(0.0));
        let mut force = -self.hose_loss * velocity * velocity.abs();
        if level > 0.0 {
            force -= level * direction(velocity);
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
