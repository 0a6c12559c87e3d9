//! Parses numbers on the command line, and rejects invalid ones.

pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text, |value| value > 0.0, "a positive number")
}

#[cfg(feature = "live")]
pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |value| value >= 0.0, "zero or a positive number")
}

pub(super) fn profile_duration(text: &str) -> Result<f64, String> {
    number(text, |value| (15.0..=600.0).contains(&value), "a number from 15 to 600")
}

pub(super) fn stroke_margin(text: &str) -> Result<f64, String> {
    number(text, |value| (0.0..=0.4).contains(&value), "a share from 0 to 0.4")
}

fn number(text: &str, fits: fn(f64) -> bool, what: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && fits(value) && value < 1e9 => Ok(value),
        _ => Err(format!("{text} is not {what}")),
    }
}
