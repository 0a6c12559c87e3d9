//! Known constants of the machine and the linkage of the arm cylinder, \[A\] Table 1.

use std::f64::consts::{FRAC_PI_3, PI};

/// Gravity, m/s².
pub const GRAVITY: f64 = 9.8;
/// Stroke L, m.
pub const STROKE: f64 = 0.6;
/// Cap side piston area A+, m².
pub const CAP_AREA: f64 = 3.8e-3;
/// Rod side piston area A-, m².
pub const ROD_AREA: f64 = 2.6e-3;
/// Dead volume V+min, m³.
pub const CAP_DEAD_VOLUME: f64 = 3.4e-4;
/// Dead volume V-min, m³.
pub const ROD_DEAD_VOLUME: f64 = 3.0e-4;
/// Pump line volume Vp, m³.
pub const PUMP_VOLUME: f64 = 1.2e-4;
/// Pump flow Qp, m³/s.
pub const PUMP_FLOW: f64 = 3.8e-4;
/// Largest opening umax of the valve section, m².
pub const MAXIMUM_OPENING: f64 = 1.15e-4;
/// Tank pressure pt, Pa gauge: the level of the practice recordings.
pub const TANK_PRESSURE: f64 = 6.0e5;
/// Pressure below which oil boils, Pa gauge.
pub const VAPOUR_PRESSURE: f64 = -9.0e4;
/// Angle q1 at which the boom is held, rad.
pub const BOOM_ANGLE: f64 = FRAC_PI_3;

const FOOT_ARM: f64 = 1.1;
const ROD_ARM: f64 = 0.33;
const MID_LENGTH: f64 = 1.10;

/// Where piston and arm stand for one joint angle: cosine law with theta = 2 pi - q.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// Piston displacement s from mid-stroke, m.
    pub displacement: f64,
    /// Lever G = ds/dq, m.
    pub lever: f64,
}

impl Geometry {
    /// Of a joint angle q in rad.
    pub fn at(joint: f64) -> Self {
        let theta = 2.0 * PI - joint;
        let (sine, cosine) = theta.sin_cos();
        let length = (FOOT_ARM * FOOT_ARM + ROD_ARM * ROD_ARM - 2.0 * FOOT_ARM * ROD_ARM * cosine).sqrt();
        // dl/dtheta = la lb sin(theta) / l, dtheta/dq = -1.
        Geometry { displacement: length - MID_LENGTH, lever: -FOOT_ARM * ROD_ARM * sine / length }
    }

    /// Joint angle q in rad of a piston displacement in m; `NaN` outside 0.77 m to 1.43 m of length.
    pub fn joint(displacement: f64) -> f64 {
        let length = MID_LENGTH + displacement;
        let cosine = (FOOT_ARM * FOOT_ARM + ROD_ARM * ROD_ARM - length * length) / (2.0 * FOOT_ARM * ROD_ARM);
        2.0 * PI - cosine.acos()
    }
}

/// Cap side volume, m³.
pub fn cap_volume(displacement: f64) -> f64 {
    CAP_DEAD_VOLUME + (STROKE / 2.0 + displacement) * CAP_AREA
}

/// Rod side volume, m³.
pub fn rod_volume(displacement: f64) -> f64 {
    ROD_DEAD_VOLUME + (STROKE / 2.0 - displacement) * ROD_AREA
}
