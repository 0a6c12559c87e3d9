//! Powers of values that may be zero.
//!
//! The slope of `x^0.5` at zero is infinite, and the product of an infinite slope with a change of zero is not a number. A
//! simulation that starts there could not take its first step.

use crate::scalar::Scalar;

/// `base^exponent`. Below `width` a power between zero and one is the odd cubic that matches its value and slope there, like the
/// laminar flow through an orifice at small pressure drops. It is not a number if the base is negative.
pub(super) fn fixed_power<T: Scalar>(base: T, exponent: f64, width: T) -> T {
    let is_steep = exponent > 0.0 && exponent < 1.0;
    if is_steep && base.value() >= 0.0 && base.value() < width.value() {
        let share = base / width;
        let cubic = share * ((3.0 - exponent) / 2.0) - share * share * share * ((1.0 - exponent) / 2.0);
        return cubic * width.powf(exponent);
    }
    if base.value() == 0.0 && exponent > 0.0 {
        return T::from(0.0);
    }
    base.powf(exponent)
}

/// `base^exponent` with a variable base and exponent.
pub(super) fn power<T: Scalar>(base: T, exponent: T) -> T {
    if base.value() == 0.0 && exponent.value() > 0.0 {
        return T::from(0.0);
    }
    (base.ln() * exponent).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{derivative, variable};

    #[test]
    fn a_power_of_zero_has_a_slope_that_is_a_number() {
        let zero = variable(0.0, 0);
        for exponent in [0.5, 1.5, 2.5] {
            let fixed = fixed_power(zero, exponent, 1e-3.into());
            assert_eq!(fixed.value(), 0.0);
            assert!(derivative(&fixed, 0).is_finite(), "{exponent}");
            assert!(derivative(&power(zero, exponent.into()), 0).is_finite(), "{exponent}");
        }
    }

    #[test]
    fn a_rounded_power_meets_the_sharp_one_with_its_slope() {
        for exponent in [0.25, 0.5, 0.8] {
            let [below, above] = [1.0 - 1e-9, 1.0].map(|x| fixed_power(variable(2.0 * x, 0), exponent, 2.0.into()));
            assert!((below.value() - above.value()).abs() < 1e-8);
            assert!((derivative(&below, 0) - derivative(&above, 0)).abs() < 1e-7);
        }
        assert!(fixed_power(-1.0_f64, 0.5, 0.1).is_nan());
    }
}
