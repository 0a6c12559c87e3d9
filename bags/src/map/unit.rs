//! Units by name.

use std::fmt;

use excavator_model::machine::CommandUnit;

use super::unit_words;

/// The dimension of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Dimension {
    Length,
    Angle,
    Velocity,
    RotationalSpeed,
    Acceleration,
    Pressure,
    Force,
    Torque,
    Flow,
    Area,
    Temperature,
    Time,
    Frequency,
    Power,
    Mass,
    Voltage,
    Current,
    Number,
}

impl Dimension {
    /// The dimension of the input of a drive.
    pub fn of_command(unit: CommandUnit) -> Dimension {
        match unit {
            CommandUnit::SquareMetre => Dimension::Area,
            CommandUnit::Volt => Dimension::Voltage,
            CommandUnit::Ampere => Dimension::Current,
            CommandUnit::One => Dimension::Number,
            CommandUnit::CubicMetrePerSecond => Dimension::Flow,
        }
    }

    /// The unit used in recordings; °C for temperatures.
    pub fn si_unit(self) -> &'static str {
        match self {
            Dimension::Length => "m",
            Dimension::Angle => "rad",
            Dimension::Velocity => "m/s",
            Dimension::RotationalSpeed => "rad/s",
            Dimension::Acceleration => "m/s2",
            Dimension::Pressure => "Pa",
            Dimension::Force => "N",
            Dimension::Torque => "Nm",
            Dimension::Flow => "m3/s",
            Dimension::Area => "m2",
            Dimension::Temperature => "degC",
            Dimension::Time => "s",
            Dimension::Frequency => "Hz",
            Dimension::Power => "W",
            Dimension::Mass => "kg",
            Dimension::Voltage => "V",
            Dimension::Current => "A",
            Dimension::Number => "1",
        }
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Dimension::Length => "length",
            Dimension::Angle => "angle",
            Dimension::Velocity => "velocity",
            Dimension::RotationalSpeed => "rotational speed",
            Dimension::Acceleration => "acceleration",
            Dimension::Pressure => "pressure",
            Dimension::Force => "force",
            Dimension::Torque => "torque",
            Dimension::Flow => "volume flow",
            Dimension::Area => "area",
            Dimension::Temperature => "temperature",
            Dimension::Time => "time",
            Dimension::Frequency => "frequency",
            Dimension::Power => "power",
            Dimension::Mass => "mass",
            Dimension::Voltage => "voltage",
            Dimension::Current => "current",
            Dimension::Number => "plain number",
        })
    }
}

/// A unit: SI value = number · `multiply` / `divide` + `add`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// As written.
    pub name: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    multiply: f64,
    /// Separate from `multiply`, since division by a thousand is exact and multiplication by its inverse is not.
    divide: f64,
    add: f64,
}

const fn unit(name: &'static str, dimension: Dimension, multiply: f64, divide: f64) -> Unit {
    Unit { name, dimension, multiply, divide, add: 0.0 }
}

const INCH: f64 = 0.0254;
const POUND_FORCE: f64 = 4.448_221_615_260_5;
const GALLON: f64 = 3.785_411_784e-3;

/// All units; the SI unit is the first of its dimension.
const UNITS: [Unit; 82] = {
    use Dimension::{
        Acceleration, Angle, Area, Current, Flow, Force, Frequency, Length, Mass, Number, Power, Pressure,
        RotationalSpeed, Temperature, Time, Torque, Velocity, Voltage,
    };
    use std::f64::consts::PI;
    [
        unit("m", Length, 1.0, 1.0),
        unit("cm", Length, 1.0, 100.0),
        unit("mm", Length, 1.0, 1e3),
        unit("um", Length, 1.0, 1e6),
        unit("in", Length, INCH, 1.0),
        unit("ft", Length, 12.0 * INCH, 1.0),
        unit("rad", Angle, 1.0, 1.0),
        unit("mrad", Angle, 1.0, 1e3),
        unit("deg", Angle, PI, 180.0),
        unit("rev", Angle, 2.0 * PI, 1.0),
        unit("m/s", Velocity, 1.0, 1.0),
        unit("cm/s", Velocity, 1.0, 100.0),
        unit("mm/s", Velocity, 1.0, 1e3),
        unit("in/s", Velocity, INCH, 1.0),
        unit("ft/s", Velocity, 12.0 * INCH, 1.0),
        unit("km/h", Velocity, 1.0, 3.6),
        unit("rad/s", RotationalSpeed, 1.0, 1.0),
        unit("deg/s", RotationalSpeed, PI, 180.0),
        unit("rpm", RotationalSpeed, 2.0 * PI, 60.0),
        unit("1/min", RotationalSpeed, 2.0 * PI, 60.0),
        unit("m/s2", Acceleration, 1.0, 1.0),
        unit("mm/s2", Acceleration, 1.0, 1e3),
        unit("Pa", Pressure, 1.0, 1.0),
        unit("hPa", Pressure, 100.0, 1.0),
        unit("kPa", Pressure, 1e3, 1.0),
        unit("GPa", Pressure, 1e9, 1.0),
        unit("MPa", Pressure, 1e6, 1.0),
        unit("mbar", Pressure, 100.0, 1.0),
        unit("bar", Pressure, 1e5, 1.0),
        unit("psi", Pressure, POUND_FORCE, INCH * INCH),
        unit("kgf/cm2", Pressure, 98_066.5, 1.0),
        unit("atm", Pressure, 101_325.0, 1.0),
        unit("N", Force, 1.0, 1.0),
        unit("kN", Force, 1e3, 1.0),
        unit("daN", Force, 10.0, 1.0),
        unit("kgf", Force, 9.806_65, 1.0),
        unit("lbf", Force, POUND_FORCE, 1.0),
        unit("Nm", Torque, 1.0, 1.0),
        unit("kNm", Torque, 1e3, 1.0),
        unit("m3/s", Flow, 1.0, 1.0),
        unit("m3/h", Flow, 1.0, 3600.0),
        unit("l/min", Flow, 1.0, 60_000.0),
        unit("lpm", Flow, 1.0, 60_000.0),
        unit("l/s", Flow, 1.0, 1e3),
        unit("ml/s", Flow, 1.0, 1e6),
        unit("cm3/s", Flow, 1.0, 1e6),
        unit("cm3/min", Flow, 1.0, 6e7),
        unit("gpm", Flow, GALLON, 60.0),
        unit("m2", Area, 1.0, 1.0),
        unit("cm2", Area, 1.0, 1e4),
        unit("mm2", Area, 1.0, 1e6),
        unit("in2", Area, INCH * INCH, 1.0),
        unit("degC", Temperature, 1.0, 1.0),
        unit("C", Temperature, 1.0, 1.0),
        Unit { name: "K", dimension: Temperature, multiply: 1.0, divide: 1.0, add: -273.15 },
        Unit { name: "degF", dimension: Temperature, multiply: 5.0, divide: 9.0, add: -160.0 / 9.0 },
        unit("s", Time, 1.0, 1.0),
        unit("ms", Time, 1.0, 1e3),
        unit("us", Time, 1.0, 1e6),
        unit("ns", Time, 1.0, 1e9),
        unit("min", Time, 60.0, 1.0),
        unit("h", Time, 3600.0, 1.0),
        unit("d", Time, 86_400.0, 1.0),
        unit("Hz", Frequency, 1.0, 1.0),
        unit("kHz", Frequency, 1e3, 1.0),
        unit("W", Power, 1.0, 1.0),
        unit("kW", Power, 1e3, 1.0),
        unit("kg", Mass, 1.0, 1.0),
        unit("V", Voltage, 1.0, 1.0),
        unit("mV", Voltage, 1.0, 1e3),
        unit("uV", Voltage, 1.0, 1e6),
        unit("kV", Voltage, 1e3, 1.0),
        unit("A", Current, 1.0, 1.0),
        unit("mA", Current, 1.0, 1e3),
        unit("1", Number, 1.0, 1.0),
        unit("-", Number, 1.0, 1.0),
        unit("%", Number, 1.0, 100.0),
        unit("pct", Number, 1.0, 100.0),
        unit("percent", Number, 1.0, 100.0),
        unit("counts", Number, 1.0, 1.0),
        unit("digits", Number, 1.0, 1.0),
        unit("LSB", Number, 1.0, 1.0),
    ]
};

impl Unit {
    /// The unit with this name: `bar`, `l/min`, `mm²`, `°C`. Case matters only where it distinguishes units (`mm`,
    /// `MM`, but `mPa` is not `MPa`).
    ///
    /// ```
    /// use excavator_bags::map::Unit;
    ///
    /// assert_eq!(Unit::named("l/min").map(|unit| unit.to_si(60.0)), Some(1e-3));
    /// assert_eq!(Unit::named("furlong"), None);
    /// ```
    pub fn named(name: &str) -> Option<Unit> {
        let name: String = name
            .trim()
            .chars()
            .filter(|c| !c.is_whitespace() && !['^', '·', '*', '\u{200b}'].contains(c))
            .map(|c| match c {
                '²' => '2',
                '³' => '3',
                'µ' | 'μ' => 'u',
                other => other,
            })
            .collect();
        let name = match name.strip_prefix('°') {
            Some("") => "deg".to_string(),
            Some(rest) => format!("deg{rest}"),
            None => name,
        };
        let name = unit_words::usual(&name).map_or(name, str::to_string);
        UNITS
            .iter()
            .find(|unit| unit.name == name)
            .or_else(|| {
                let mut alike = UNITS.iter().filter(|unit| unit.name.eq_ignore_ascii_case(&name) && name != "mPa");
                alike.next().filter(|_| alike.next().is_none())
            })
            .copied()
    }

    /// The SI unit of a dimension; °C for temperatures.
    pub fn si(dimension: Dimension) -> Unit {
        let name = dimension.si_unit();
        UNITS.iter().find(|unit| unit.name == name).copied().unwrap_or(unit(name, dimension, 1.0, 1.0))
    }

    /// Converts a number in this unit to SI.
    pub fn to_si(&self, number: f64) -> f64 {
        let scaled = if self.multiply == 1.0 { number } else { number * self.multiply };
        let scaled = if self.divide == 1.0 { scaled } else { scaled / self.divide };
        if self.add == 0.0 { scaled } else { scaled + self.add }
    }

    /// SI value of one unit, as a factor: without the offset of a temperature scale.
    pub fn factor(&self) -> f64 {
        self.multiply / self.divide
    }

    /// All names, for display.
    pub fn names() -> String {
        UNITS.iter().map(|unit| unit.name).collect::<Vec<_>>().join(", ")
    }
}
