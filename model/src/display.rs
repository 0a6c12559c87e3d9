//! The unit in which pressures are displayed.
//!
//! Like a locale, it is a user setting for the whole process. It affects display only: internal values, JSON, model files and
//! bags are always in Pa.

use std::sync::atomic::{AtomicBool, Ordering};

/// A display unit for pressures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PressureUnit {
    /// MPa, the default: SI, and in the data sheets of most machines.
    #[default]
    Megapascal,
    /// bar.
    Bar,
}

static IN_BAR: AtomicBool = AtomicBool::new(false);

impl PressureUnit {
    /// The unit in which this process shows pressures.
    pub fn shown() -> Self {
        if IN_BAR.load(Ordering::Relaxed) { PressureUnit::Bar } else { PressureUnit::Megapascal }
    }

    /// Shows pressures in this unit from now on.
    pub fn show(self) {
        IN_BAR.store(self == PressureUnit::Bar, Ordering::Relaxed);
    }

    /// Displayed value of 1 Pa.
    pub fn factor(self) -> f64 {
        match self {
            PressureUnit::Megapascal => 1e-6,
            PressureUnit::Bar => 1e-5,
        }
    }

    /// Symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            PressureUnit::Megapascal => "MPa",
            PressureUnit::Bar => "bar",
        }
    }
}

/// Formats a pressure in Pa with three significant digits and the display unit of this process.
pub fn pressure_text(pascal: f64) -> String {
    let unit = PressureUnit::shown();
    let value = unit.factor() * pascal;
    let before_point = if value == 0.0 || !value.is_finite() { 1.0 } else { value.abs().log10().floor() + 1.0 };
    let decimals = (3.0 - before_point).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$} {}", unit.symbol())
}

#[cfg(test)]
mod tests {
    use super::pressure_text;

    #[test]
    fn three_digits_are_shown() {
        assert_eq!(pressure_text(336_456.0), "0.336 MPa");
        assert_eq!(pressure_text(21.04e6), "21.0 MPa");
        assert_eq!(pressure_text(1.5e9), "1500 MPa");
        assert_eq!(pressure_text(0.0), "0.00 MPa");
    }
}
