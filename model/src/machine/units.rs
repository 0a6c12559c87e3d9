//! Units that depend on the machine: a motor rotates where a cylinder translates, and a valve's input is not always
//! an area.

use std::borrow::Cow;

use super::{Cylinder, Growth};

/// Unit of the input of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CommandUnit {
    /// Orifice area, m².
    SquareMetre,
    /// Voltage, V.
    Volt,
    /// Current, A.
    Ampere,
    /// Share of the full command, a pure number.
    One,
    /// Flow of a pump without losses, m³/s.
    CubicMetrePerSecond,
}

impl CommandUnit {
    /// Its text in model files.
    pub fn text(self) -> &'static str {
        match self {
            CommandUnit::SquareMetre => "m2",
            CommandUnit::Volt => "V",
            CommandUnit::Ampere => "A",
            CommandUnit::One => "-",
            CommandUnit::CubicMetrePerSecond => "m3/s",
        }
    }

    /// Factor and symbol of the display unit.
    pub fn for_people(self) -> (f64, &'static str) {
        match self {
            CommandUnit::SquareMetre => (1e6, "mm2"),
            CommandUnit::Volt => (1.0, "V"),
            CommandUnit::Ampere => (1e3, "mA"),
            CommandUnit::One => (1e2, "%"),
            CommandUnit::CubicMetrePerSecond => (6e4, "l/min"),
        }
    }

    /// Unit of a flow per square root of pressure drop and per input.
    pub fn flow_gain(self) -> &'static str {
        match self {
            CommandUnit::SquareMetre => "m/(s sqrt(Pa))",
            CommandUnit::Volt => "m3/(s V sqrt(Pa))",
            CommandUnit::Ampere => "m3/(s A sqrt(Pa))",
            CommandUnit::One => "m3/(s sqrt(Pa))",
            CommandUnit::CubicMetrePerSecond => "1/sqrt(Pa)",
        }
    }
}

impl Cylinder {
    /// Unit of a parameter at this cylinder, where `unit` is that for a cylinder whose valve is given by its orifice
    /// area.
    pub fn unit_of(&self, unit: &str, growth: Growth) -> Cow<'static, str> {
        let command = self.chambers.map(|chambers| chambers.drive.command_unit());
        let is_motor = self.is_motor();
        let own = match (growth, unit, command) {
            (Growth::OPENING, _, Some(command)) => Some(command.text()),
            (Growth::FLOW_GAIN, _, Some(command)) => Some(command.flow_gain()),
            (Growth::LENGTH, "m", _) if is_motor => Some("rad"),
            (Growth::SEAL_SPEED, "m/s", _) if is_motor => Some("rad/s"),
            (Growth::PER_SPEED, "s/m", _) if is_motor => Some("s/rad"),
            (Growth::DAMPING, "N s/m", _) if is_motor => Some("N m s/rad"),
            (Growth::DRAG, "N s2/m2", _) if is_motor => Some("N m s2/rad2"),
            (Growth::FORCE, "N", _) if is_motor => Some("N m"),
            (Growth::FORCE, "m2", _) if is_motor => Some("m3/rad"),
            (Growth::STIFFNESS, "N/m", _) if is_motor => Some("N m/rad"),
            _ => None,
        };
        own.map_or_else(|| Cow::Owned(unit.to_string()), Cow::Borrowed)
    }

    /// Units of displacement and velocity.
    pub fn motion_units(&self) -> [&'static str; 2] {
        if self.is_motor() { ["rad", "rad/s"] } else { ["m", "m/s"] }
    }
}
