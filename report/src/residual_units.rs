//! Display units of residuals and of the variables that they depend on.

use excavator_model::machine::Machine;

use super::units::{self, Unit};

/// Unit of a variable of [`excavator_identification::diagnosis::Unexplained`], for an equation like `arm.motion`.
pub(super) fn unit_of_variable(machine: &Machine, equation: &str, variable: &str) -> Unit<'static> {
    let place = equation.split('.').next().unwrap_or(equation);
    // The residual of the pump line depends on the sum over all cylinders.
    let cylinder = machine.cylinders.iter().find(|cylinder| cylinder.name == place).or(machine.cylinders.first());
    match variable {
        "command" => units::of_opening(cylinder),
        "speed" => units::of_speed(cylinder),
        "position" => units::of_position(cylinder),
        "time" => units::SECOND,
        _ => units::pressure(),
    }
}

/// Unit of a residual with this SI unit.
pub(super) fn unit_of_residual(si: &str) -> Unit<'_> {
    if si == "m3/s" { units::LITRE_PER_MINUTE } else { Unit { factor: 1.0, symbol: si } }
}
