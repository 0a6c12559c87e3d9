//! Units that residuals, and the variables they follow, are shown in.

use super::units::{self, Unit};

/// Of a variable of [`crate::diagnosis::Unexplained`].
pub(super) fn unit_of_variable(variable: &str) -> Unit<'static> {
    match variable {
        "command" => units::SQUARE_MILLIMETRE,
        "speed" => units::MILLIMETRE_PER_SECOND,
        "position" => units::MILLIMETRE,
        "time" => units::SECOND,
        _ => units::MEGAPASCAL,
    }
}

/// Of a residual whose SI unit is given.
pub(super) fn unit_of_residual(si: &str) -> Unit<'_> {
    if si == "m3/s" { units::LITRE_PER_MINUTE } else { Unit { factor: 1.0, symbol: si } }
}
