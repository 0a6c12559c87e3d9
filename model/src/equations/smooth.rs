//! Smooth approximations of the corners of the physics, with the widths over which the corners are rounded.

use crate::scalar::Scalar;

/// Speed over which the sign of the velocity changes, m/s. Well below any working speed of an arm (0.1 m/s), yet wide enough that
/// a stuck piston creeps by less than 1 mm in a second at the friction level.
pub const SLIP_SPEED: f64 = 1.0e-3;

/// Pressure drop below which an orifice is treated as laminar, Pa. The resistance number of a sharp-edged metering slot (about
/// 10) puts the transition of a 1e-4 m² opening between 1 kPa and 10 kPa for mineral oil.
pub const LAMINAR_PRESSURE: f64 = 2.0e3;

/// The hyperbolic tangent: a sign function rounded over one.
///
/// It uses one exponential and returns one beyond the precision of a double. `num_dual` divides the hyperbolic sine by the
/// cosine, which overflow at a ratio of 360 and give a derivative that is not a number.
pub fn rounded_sign<T: Scalar>(ratio: T) -> T {
    if ratio.value().abs() > FULL_SLIP {
        return T::from(ratio.value().signum());
    }
    let excess = (ratio * 2.0).exp_m1();
    excess / (excess + 2.0)
}

/// A sign function rounded over one, with a corner of another shape: [`rounded_sign`] of a ratio x that is bent to `sinh(sqrt(q)
/// x) / sqrt(q)`, for a sharpness q below zero `asinh(sqrt(-q) x) / sqrt(-q)`; both are `x + q x³/6` for small x.
///
/// Minus one gives `x / sqrt(1 + x²)`, zero the hyperbolic tangent, four nearly a straight line limited at one.
pub fn sign_with_corner<T: Scalar>(ratio: T, sharpness: T) -> T {
    let (x, q) = (ratio.value(), sharpness.value());
    if (q * x * x).abs() < NEARLY_STRAIGHT {
        let cubed = ratio * ratio * ratio;
        return rounded_sign(ratio + sharpness * cubed / 6.0);
    }
    if q < 0.0 {
        let root = (-sharpness).sqrt();
        return rounded_sign((ratio * root).asinh() / root);
    }
    if x.abs() > FULL_SLIP {
        return T::from(x.signum());
    }
    let root = sharpness.sqrt();
    rounded_sign((ratio * root).sinh() / root)
}

/// Bend below which the next term, at most `3 q² x⁴ / 40` of the ratio, is negligible in double precision.
const NEARLY_STRAIGHT: f64 = 1e-5;

/// A step from zero to one, rounded over one: `(1 + tanh(ratio)) / 2`, without cancellation where it is small.
pub fn rounded_step<T: Scalar>(ratio: T) -> T {
    if ratio.value().abs() > FULL_SLIP {
        return T::from(if ratio.value() > 0.0 { 1.0 } else { 0.0 });
    }
    ((ratio * -2.0).exp() + 1.0).recip()
}

/// One from `begin` on for `duration`, zero before and after (all s). The edges are rounded over 30 ms times `time_scale`, which
/// depends on the size of the machine.
pub fn window<T: Scalar>(time: T, begin: T, duration: T, time_scale: f64) -> T {
    let edge = EDGE * time_scale;
    let since = time - begin;
    rounded_step(since / edge) * rounded_step((duration - since) / edge)
}

/// Time over which a window opens and closes, s: several integrator steps, and longer than a sample interval, so that a fit can
/// locate the edges.
const EDGE: f64 = 0.03;

/// Ratio beyond which the hyperbolic tangent is one in double precision.
const FULL_SLIP: f64 = 20.0;

/// `sgn(x) sqrt|x|` of a pressure drop in Pa, linear below a transition pressure d (Pa): `x / (x² + d²)^(1/4)`.
///
/// \[A\] prints only the root; the sign lets the flow reverse when the supply pressure is below the chamber pressure.
pub fn orifice_root<T: Scalar>(pressure_drop: T, transition: T) -> T {
    let squared = pressure_drop * pressure_drop + transition * transition;
    pressure_drop / squared.sqrt().sqrt()
}

/// The smaller of a pressure drop and a positive margin (Pa), rounded where they meet: `d / (1 + (d/m)^8)^(1/8)`. It is 8 % below
/// the corner where they are equal, and within 0.05 % of the smaller one at half and twice the margin. A drop of zero or less is
/// returned unchanged: nothing flows without a pressure drop.
pub fn at_most<T: Scalar>(pressure_drop: T, margin: T) -> T {
    if pressure_drop.value() <= 0.0 {
        return pressure_drop;
    }
    let ratio = pressure_drop / margin;
    // Far above the margin the powers of the ratio would lose precision.
    if ratio.value() > FULLY_COMPENSATED {
        return margin;
    }
    pressure_drop / (ratio.powi(8) + 1.0).sqrt().sqrt().sqrt()
}

/// Ratio of drop to margin beyond which the result equals the margin in double precision.
const FULLY_COMPENSATED: f64 = 100.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{derivative, variable};

    /// On every branch, and where branches meet.
    #[test]
    fn corners_have_the_slopes_that_they_say() {
        for sharpness in [-4.0, -1.0, -1e-6, 0.0, 1e-6, 1.0, 15.0] {
            for ratio in [-30.0, -2.0, -0.9, -1e-3, 0.0, 0.4, 3.1, 19.0] {
                let found = sign_with_corner(variable(ratio, 0), variable(sharpness, 1));
                let step = 1e-5;
                let by_ratio = sign_with_corner(ratio + step, sharpness) - sign_with_corner(ratio - step, sharpness);
                let by_sharpness =
                    sign_with_corner(ratio, sharpness + step) - sign_with_corner(ratio, sharpness - step);
                for (direction, difference) in [by_ratio, by_sharpness].into_iter().enumerate() {
                    let (slope, wanted) = (derivative(&found, direction), difference / (2.0 * step));
                    assert!(
                        (slope - wanted).abs() < 1e-4,
                        "{slope} is not {wanted} at ratio {ratio}, sharpness {sharpness}"
                    );
                }
            }
        }
    }
}
