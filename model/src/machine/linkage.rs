//! Kinematics between piston and joint.

use crate::scalar::Scalar;

/// Kinematics between piston displacement s (m from mid-stroke; shaft angle in rad for a motor) and joint coordinate q (rad, or m
/// for a linear load).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Linkage {
    /// Cylinder pinned across a joint, cosine law: `l² = la² + lb² - 2 la lb cos(theta)`, `l = lc + s`.
    Triangle {
        /// Distance la from the joint to the cylinder's foot pin, m.
        foot_arm: f64,
        /// Distance lb from the joint to the rod's pin, m.
        rod_arm: f64,
        /// Pin-to-pin length lc at mid-stroke, m. Table 1 of \[A\] prints 0.28 m, which cannot be a pin-to-pin length
        /// with its other numbers: the cosine law allows 0.77 m to 1.43 m.
        mid_stroke_length: f64,
        /// `false`: theta = q (boom); `true`: theta = 2 pi - q (arm), so that extension lowers q.
        mirrored: bool,
    },
    /// The piston moves the load directly: q = s, \[B\] Eq. 5.
    Direct,
    /// A motor turns the joint through a gear: shaft angle s = n q.
    Gear {
        /// Shaft turns n per turn of the joint; negative if they turn in opposite directions.
        ratio: f64,
    },
}

impl Linkage {
    /// Piston displacement s(q) in m.
    pub fn displacement<T: Scalar>(&self, joint: T) -> T {
        match *self {
            // The cosine is the same for q and 2 pi - q, so the mirrored arm needs no special case here.
            Linkage::Triangle { foot_arm, rod_arm, mid_stroke_length, .. } => {
                let squared = joint.cos() * (-2.0 * foot_arm * rod_arm) + (foot_arm * foot_arm + rod_arm * rod_arm);
                squared.sqrt() - mid_stroke_length
            }
            Linkage::Direct => joint,
            Linkage::Gear { ratio } => joint * ratio,
        }
    }

    /// Lever G = ds/dq in m (1 for a direct load), \[A\] Eq. 1: `G11 = la lb sin(q)/l`, `G22 = -la lb sin(2 pi - q)/l`.
    /// Both are `la lb sin(q) / l`; the mirrored arm has q between pi and 2 pi, so its lever is negative.
    pub fn lever<T: Scalar>(&self, joint: T) -> T {
        match *self {
            Linkage::Triangle { foot_arm, rod_arm, mid_stroke_length, .. } => {
                let length = self.displacement(joint) + mid_stroke_length;
                joint.sin() * (foot_arm * rod_arm) / length
            }
            Linkage::Direct => T::from(1.0),
            Linkage::Gear { ratio } => T::from(ratio),
        }
    }

    /// Joint coordinate q(s); `NaN` if the triangle cannot close.
    pub fn joint(&self, displacement: f64) -> f64 {
        match *self {
            Linkage::Triangle { foot_arm, rod_arm, mid_stroke_length, mirrored } => {
                let length = mid_stroke_length + displacement;
                let cosine = (foot_arm * foot_arm + rod_arm * rod_arm - length * length) / (2.0 * foot_arm * rod_arm);
                let interior = cosine.acos();
                if mirrored { 2.0 * std::f64::consts::PI - interior } else { interior }
            }
            Linkage::Direct => displacement,
            Linkage::Gear { ratio } => displacement / ratio,
        }
    }
}
