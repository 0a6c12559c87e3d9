//! Formats numbers for users.

/// A number with four significant digits, short.
///
/// ```
/// use excavator_study::numbers::number;
///
/// assert_eq!([21.3456, 2.1e-7, f64::NAN].map(number), ["21.35", "2.100e-7", "-"]);
/// ```
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return "-".to_string();
    }
    let size = value.abs();
    if size == 0.0 {
        "0".to_string()
    } else if (0.01..1e5).contains(&size) {
        let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.3e}")
    }
}
