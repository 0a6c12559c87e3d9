//! Effects in nobody's catalogue.

use std::f64::consts::TAU;

/// Inertia of boom and arm about the boom's foot, kg m²: `I1 + I2 + m1 lg1² + m2 (l1² + lg2²)`.
pub const BOOM_INERTIA: f64 = 95.0 + 40.0 + 190.0 * 1.1 * 1.1 + 190.0 * (2.5 * 2.5 + 1.0);
/// R12 = m2 lg2 l1, kg m².
pub const COUPLING: f64 = 190.0 * 1.0 * 2.5;
/// W1 = m1 lg1 + m2 l1, kg m.
pub const BOOM_GRAVITY_MOMENT: f64 = 190.0 * 1.1 + 190.0 * 2.5;
/// Mass of piston and rod, kg; looked at only where the pin has play.
pub const PISTON_MASS: f64 = 25.0;
/// Contact stiffness of the pin, N/m.
const PIN_STIFFNESS: f64 = 3e7;
/// Contact damping of the pin, N s/m.
const PIN_DAMPING: f64 = 8e3;
/// Time in which an engine answers a load, s.
pub const ENGINE_TIME: f64 = 0.1;

/// Effects that no catalogue lists.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Foreign {
    /// The boom is held by a spring: one over its stiffness, rad/(N m).
    pub boom_compliance: f64,
    /// Friction of a damaged stretch of the barrel, N.
    pub bump_force: f64,
    /// Where it is, m.
    pub bump_place: f64,
    /// Its half width, m.
    pub bump_width: f64,
    /// Mean of a leakage past the piston that comes and goes along the stroke, m³/(s Pa).
    pub stroke_leakage: f64,
    /// Its period, m.
    pub stroke_period: f64,
    /// Share by which viscous damping falls at once when warm oil arrives.
    pub viscosity_step: f64,
    /// When that is, as a share of the recording.
    pub viscosity_time: f64,
    /// Share of pump flow lost per 1 rad/s² of arm acceleration: the engine droops.
    pub engine_droop: f64,
    /// Play of the rod's pin, m.
    pub pin_play: f64,
    /// Share of the opening that flow forces take per MPa of pressure drop.
    pub flow_force: f64,
    /// Gain of a secondary relief valve from the cap side to tank, m³/(s Pa).
    pub port_relief_gain: f64,
    /// Its cracking pressure, Pa.
    pub port_relief_pressure: f64,
    /// Resistance of a clogged filter in the return line, s² Pa/m⁶: drop over the square of the flow.
    pub return_resistance: f64,
    /// Stiffness of a balance spring at the joint, N m/rad.
    pub spring_stiffness: f64,
    /// Joint angle at which it is slack, rad.
    pub spring_angle: f64,
    /// Share by which all flow gains of the valve grow over a recording.
    pub gain_drift: f64,
}

impl Foreign {
    /// Friction on the damaged stretch, N, before its sign.
    pub fn bump(&self, displacement: f64) -> f64 {
        if self.bump_force == 0.0 {
            return 0.0;
        }
        let away = (displacement - self.bump_place) / self.bump_width;
        self.bump_force * (-away * away).exp()
    }

    /// Leakage coefficient past the piston at a displacement, m³/(s Pa).
    pub fn leakage(&self, displacement: f64) -> f64 {
        if self.stroke_leakage == 0.0 {
            return 0.0;
        }
        self.stroke_leakage * (1.0 + (TAU * displacement / self.stroke_period).sin())
    }

    /// Factor on viscous damping at a time of a recording, both s; the warm oil arrives within 0.5 s.
    pub fn damping_factor(&self, time: f64, duration: f64) -> f64 {
        1.0 - self.viscosity_step * ((time - self.viscosity_time * duration) / 0.5).clamp(0.0, 1.0)
    }

    /// Flow through the secondary relief valve at the cap side, m³/s.
    pub fn port_relief(&self, cap: f64) -> f64 {
        self.port_relief_gain * (cap - self.port_relief_pressure).max(0.0)
    }

    /// Gain of a metering edge and the return filter in series, both m³/(s sqrt(Pa)): their drops add up.
    pub fn before_filter(&self, gain: f64) -> f64 {
        gain / (1.0 + self.return_resistance * gain * gain).sqrt()
    }

    /// Torque of the balance spring on the arm, N m, at a joint angle in rad.
    pub fn spring(&self, joint: f64) -> f64 {
        -self.spring_stiffness * (joint - self.spring_angle)
    }

    /// Factor on the flow gains of the valve at a time of a recording, both s.
    pub fn gain_factor(&self, time: f64, duration: f64) -> f64 {
        if self.gain_drift == 0.0 { 1.0 } else { 1.0 + self.gain_drift * time / duration }
    }

    /// Force of the pin on the arm, N, for a lead of the piston over the arm (m) and its rate (m/s); never pulls back.
    pub fn pin_force(&self, lead: f64, rate: f64) -> f64 {
        let half = self.pin_play / 2.0;
        if lead > half {
            (PIN_STIFFNESS * (lead - half) + PIN_DAMPING * rate).max(0.0)
        } else if lead < -half {
            (PIN_STIFFNESS * (lead + half) + PIN_DAMPING * rate).min(0.0)
        } else {
            0.0
        }
    }
}
