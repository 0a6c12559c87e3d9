//! Converts SI units to the units on gauges.

use std::f64::consts::PI;

use excavator_model::display::PressureUnit;
use excavator_model::machine::{CommandUnit, Cylinder, Machine, Mechanism};

/// A unit for display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit<'a> {
    /// Displayed value = SI value times this.
    pub factor: f64,
    /// Symbol.
    pub symbol: &'a str,
}

const fn unit(factor: f64, symbol: &str) -> Unit<'_> {
    Unit { factor, symbol }
}

/// Displacements.
const MILLIMETRE: Unit<'static> = unit(1e3, "mm");
/// Speeds.
const MILLIMETRE_PER_SECOND: Unit<'static> = unit(1e3, "mm/s");
/// Openings.
const SQUARE_MILLIMETRE: Unit<'static> = unit(1e6, "mm²");
/// Forces of cylinders.
pub(super) const KILONEWTON: Unit<'static> = unit(1e-3, "kN");
/// Flows.
pub(super) const LITRE_PER_MINUTE: Unit<'static> = unit(6e4, "l/min");
/// Times.
pub(super) const SECOND: Unit<'static> = unit(1.0, "s");

/// Pressures, in the unit that the user chose.
pub(super) fn pressure() -> Unit<'static> {
    let shown = PressureUnit::shown();
    unit(shown.factor(), shown.symbol())
}

/// Angles of joints.
const DEGREE: Unit<'static> = unit(180.0 / PI, "°");

/// Unit for the position of a piston or of a motor's shaft.
pub(super) fn of_position(cylinder: Option<&Cylinder>) -> Unit<'static> {
    if cylinder.is_some_and(Cylinder::is_motor) { unit(0.5 / PI, "rev") } else { MILLIMETRE }
}

/// Unit for the speed of a piston or of a motor's shaft.
pub(super) fn of_speed(cylinder: Option<&Cylinder>) -> Unit<'static> {
    if cylinder.is_some_and(Cylinder::is_motor) { unit(30.0 / PI, "rpm") } else { MILLIMETRE_PER_SECOND }
}

/// Unit for the input of a cylinder's drive.
pub(super) fn of_opening(cylinder: Option<&Cylinder>) -> Unit<'static> {
    match cylinder.and_then(|cylinder| cylinder.chambers).map(|chambers| chambers.drive.command_unit()) {
        Some(CommandUnit::SquareMetre) | None => SQUARE_MILLIMETRE,
        Some(other) => {
            let (factor, symbol) = other.for_people();
            unit(factor, symbol)
        }
    }
}

/// Factor from SI to the unit in which a signal of this contract name is shown, and the symbol of that unit.
pub fn signal_unit(machine: &Machine, name: &str) -> (f64, &'static str) {
    let unit = of_signal(machine, name);
    (unit.factor, unit.symbol)
}

/// Unit in which a signal of this contract name is shown.
pub(super) fn of_signal(machine: &Machine, name: &str) -> Unit<'static> {
    let (place, signal) = name.rsplit_once('.').unwrap_or(("", name));
    let cylinder = machine.cylinders.iter().find(|cylinder| cylinder.name == place);
    match signal {
        // The coordinate of a linear load is its position.
        "joint_angle" if machine.mechanism == Mechanism::LinearLoad => MILLIMETRE,
        "joint_angle" => DEGREE,
        "displacement" => of_position(cylinder),
        "velocity" => of_speed(cylinder),
        "orifice_area" | "orifice_command" => of_opening(cylinder),
        "rod_force" if cylinder.is_some_and(Cylinder::is_motor) => unit(1.0, "N m"),
        "rod_force" => KILONEWTON,
        "pump_flow" => LITRE_PER_MINUTE,
        "oil_temperature" => unit(1.0, "°C"),
        name if name.ends_with("pressure") => pressure(),
        _ => unit(1.0, "SI"),
    }
}

/// Unit in which a parameter with this SI unit is shown.
pub(super) fn of_parameter(si: &str) -> Unit<'_> {
    match si {
        "m" => MILLIMETRE,
        "m2" => SQUARE_MILLIMETRE,
        "m/s" => MILLIMETRE_PER_SECOND,
        "Pa" => pressure(),
        "s" => unit(1e3, "ms"),
        "-" => unit(1.0, ""),
        "kg m2" => unit(1.0, "kg m²"),
        "N s2/m2" => unit(1.0, "N s²/m²"),
        "m3/(s Pa)" => unit(1.0, "m³/(s Pa)"),
        "m/(s sqrt(Pa))" => unit(1.0, "m/(s √Pa)"),
        "m3" => unit(1.0, "m³"),
        "m3/s" => LITRE_PER_MINUTE,
        "rad/s" => unit(30.0 / PI, "rpm"),
        "A" => unit(1e3, "mA"),
        other => unit(1.0, other),
    }
}
