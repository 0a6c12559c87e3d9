//! Formats numbers for readers.

/// Placeholder for a missing number.
pub(super) const NOTHING: &str = "–";

/// `value` with `digits` significant digits, with a power of ten if plain digits would be hard to read.
pub(super) fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return NOTHING.to_string();
    }
    if value == 0.0 {
        return "0".to_string();
    }
    let scientific = format!("{:.*e}", digits.saturating_sub(1), value);
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..=5).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return with_minus(&format!("{value:.decimals$}"));
    }
    format!("{} × 10{}", with_minus(mantissa), superscript(exponent))
}

/// Standard errors to either side of a value within which the truth lies in 95 % of cases.
pub(super) const SIDES_95: f64 = 1.96;

/// A value with the half width of its 95 % interval to two digits, rounded alike: `4.21 ± 0.13`; both with one power of ten.
pub(super) fn with_margin(value: f64, error: f64) -> String {
    if !(error.is_finite() && error > 0.0) {
        return plain(value);
    }
    let larger = value.abs().max(error);
    let exponent = larger.log10().floor() as i32;
    let shift = if (-3..=5).contains(&exponent) { 0 } else { exponent };
    let scale = 10_f64.powi(shift);
    let last = error.log10().floor() as i32 - 1 - shift;
    let decimals = (-last).clamp(0, 9) as usize;
    let pair = format!("{} ± {:.decimals$}", with_minus(&format!("{:.decimals$}", value / scale)), error / scale);
    if shift == 0 { pair } else { format!("({pair}) × 10{}", superscript(shift)) }
}

/// A known value with its own digits, four at most.
fn plain(value: f64) -> String {
    let text = significant(value, 4);
    let (mantissa, power) = text.split_once(" × ").map_or((text.as_str(), None), |(m, p)| (m, Some(p)));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    power.map_or(mantissa.to_string(), |power| format!("{mantissa} × {power}"))
}

/// Change of the error measure that models are compared by, for the end of a sentence
pub(super) fn change_of_error([before, after]: [f64; 2]) -> String {
    let (from, to) = (significant(before, 3), significant(after, 3));
    if after < before {
        format!("falls from {from} to {to} ({} times smaller)", ratio(before / after))
    } else {
        format!("goes from {from} to {to}")
    }
}

/// A fraction in percent.
pub(super) fn percent(fraction: f64) -> String {
    match 100.0 * fraction {
        value if !value.is_finite() => NOTHING.to_string(),
        value if value <= 0.0 && value > -0.05 => "0 %".to_string(),
        value if value > 0.0 && value < 0.05 => "< 0.1 %".to_string(),
        value if value.abs() < 10.0 => format!("{} %", with_minus(&format!("{value:.1}"))),
        value => format!("{} %", with_minus(&format!("{value:.0}"))),
    }
}

/// One decimal, and no minus before zero.
pub(super) fn decimal(value: f64) -> String {
    let rounded = (value * 10.0).round() / 10.0;
    with_minus(&format!("{:.1}", if rounded == 0.0 { 0.0 } else { rounded }))
}

/// Factor by which a squared error decreases: "12 times less".
pub(super) fn ratio(times: f64) -> String {
    match times {
        times if !times.is_finite() => NOTHING.to_string(),
        times if times >= 100.0 => format!("{times:.0}"),
        times if times >= 10.0 => format!("{times:.1}"),
        times => format!("{times:.2}"),
    }
}

fn with_minus(text: &str) -> String {
    text.replace('-', "−")
}

/// 10 to the power of `exponent`.
pub(super) fn power_of_ten(exponent: i32) -> String {
    format!("10{}", superscript(exponent))
}

/// The exponent in a text from [`power_of_ten`].
pub(super) fn exponent_in(power: &str) -> Option<i32> {
    const DIGITS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let digits: Option<String> = power
        .strip_prefix("10")?
        .chars()
        .map(|raised| {
            if raised == '⁻' {
                return Some('-');
            }
            let value = DIGITS.chars().position(|digit| digit == raised)?;
            char::from_digit(value as u32, 10)
        })
        .collect();
    digits?.parse().ok()
}

pub(super) fn superscript(exponent: i32) -> String {
    exponent
        .to_string()
        .chars()
        .map(|digit| match digit {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            '9' => '⁹',
            _ => '⁰',
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_what_is_known() {
        assert_eq!(significant(0.001234, 3), "0.00123");
        assert_eq!(significant(-1.2345e-12, 3), "−1.23 × 10⁻¹²");
        assert_eq!(significant(f64::NAN, 3), NOTHING);
        assert_eq!(with_margin(4.2134, 0.134), "4.21 ± 0.13");
        assert_eq!(with_margin(1.2341e-12, 3.4e-14), "(1.234 ± 0.034) × 10⁻¹²");
        assert_eq!(with_margin(2.0, f64::INFINITY), "2");
        assert_eq!(with_margin(5e7, f64::NAN), "5 × 10⁷");
        assert_eq!(percent(0.0123), "1.2 %");
        assert_eq!(decimal(-0.01), "0.0");
        assert_eq!(percent(0.0001), "< 0.1 %");
        assert_eq!(percent(-0.0), "0 %");
        assert_eq!(exponent_in(&power_of_ten(-120)), Some(-120));
        assert_eq!(exponent_in("100"), None);
    }
}
