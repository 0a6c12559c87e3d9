//! Units as powers of metre, kilogram, second, kelvin and ampere.

/// Powers are counted in twelfths, so that roots of roots stay integers.
const WHOLE: i32 = 12;

/// The base units, in the order of the powers.
const BASE: [&str; 5] = ["m", "kg", "s", "K", "A"];

/// The dimension of a quantity in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Dimension {
    /// Powers of the base units, in twelfths.
    powers: [i32; BASE.len()],
}

/// A unit that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("\"{unit}\" is no SI unit: {reason}; write it like \"N s/(m Pa)\", \"m3/s\" or \"-\" for a pure number")]
#[non_exhaustive]
pub struct UnitError {
    /// The text.
    pub unit: String,
    /// The reason.
    pub reason: String,
}

/// Units with a name, and their powers. Angles are pure numbers.
const NAMED: [(&str, [i32; 5]); 19] = [
    ("-", [0, 0, 0, 0, 0]),
    ("1", [0, 0, 0, 0, 0]),
    ("rad", [0, 0, 0, 0, 0]),
    ("m", [1, 0, 0, 0, 0]),
    ("kg", [0, 1, 0, 0, 0]),
    ("s", [0, 0, 1, 0, 0]),
    ("K", [0, 0, 0, 1, 0]),
    ("degC", [0, 0, 0, 1, 0]),
    ("A", [0, 0, 0, 0, 1]),
    ("N", [1, 1, -2, 0, 0]),
    ("Pa", [-1, 1, -2, 0, 0]),
    ("J", [2, 1, -2, 0, 0]),
    ("W", [2, 1, -3, 0, 0]),
    ("Hz", [0, 0, -1, 0, 0]),
    ("V", [2, 1, -3, 0, -1]),
    ("m2", [2, 0, 0, 0, 0]),
    ("m3", [3, 0, 0, 0, 0]),
    ("s2", [0, 0, 2, 0, 0]),
    ("m6", [6, 0, 0, 0, 0]),
];

/// Common units, for messages: the first match is used.
const READABLE: [&str; 20] = [
    "m",
    "m2",
    "m3",
    "s",
    "kg",
    "N",
    "Pa",
    "W",
    "K",
    "A",
    "m/s",
    "m/s2",
    "1/s",
    "m3/s",
    "N m",
    "N s/m",
    "N/m",
    "m3/(s Pa)",
    "1/Pa",
    "Pa/s",
];

impl Dimension {
    /// The dimension of a pure number.
    pub const PURE: Dimension = Dimension { powers: [0; BASE.len()] };

    /// Whether it is the dimension of a pure number.
    pub fn is_pure(self) -> bool {
        self == Dimension::PURE
    }

    /// The dimension of a product.
    pub fn times(self, other: Dimension) -> Dimension {
        self.combine(other, 1)
    }

    /// The dimension of a quotient.
    pub fn over(self, other: Dimension) -> Dimension {
        self.combine(other, -1)
    }

    fn combine(self, other: Dimension, sign: i32) -> Dimension {
        let mut powers = self.powers;
        for (power, other) in powers.iter_mut().zip(other.powers) {
            *power = power.saturating_add(sign * other);
        }
        Dimension { powers }
    }

    /// The dimension of a power; `None` if a base unit's power would not be an integer number of twelfths, or more than
    /// a hundred.
    pub fn to_the(self, exponent: f64) -> Option<Dimension> {
        let mut powers = self.powers;
        for power in &mut powers {
            let scaled = f64::from(*power) * exponent;
            let rounded = scaled.round();
            if !((scaled - rounded).abs() < 1e-9 && rounded.abs() <= f64::from(100 * WHOLE)) {
                return None;
            }
            *power = rounded as i32;
        }
        Some(Dimension { powers })
    }

    /// Parses a unit: names with powers (`m3`, `s^2`, `Pa^0.5`, `sqrt(Pa)`) in a product, at most one `/` on each
    /// level.
    ///
    /// # Errors
    /// [`UnitError`] with the unknown name.
    pub fn read(text: &str) -> Result<Dimension, UnitError> {
        let error = |reason: String| UnitError { unit: text.chars().take(40).collect(), reason };
        if text.len() > LONGEST {
            return Err(error(format!("it is longer than {LONGEST} characters")));
        }
        if text == "-" {
            return Ok(Dimension::PURE);
        }
        let mut reader = Reader { rest: text.trim(), depth: 0 };
        let dimension = reader.quotient().map_err(error)?;
        if reader.rest.is_empty() { Ok(dimension) } else { Err(error(format!("\"{}\" is left over", reader.rest))) }
    }

    /// The unit for a message: a named one if there is one, otherwise a product of base units.
    pub fn text(self) -> String {
        if self.is_pure() {
            return "a pure number".to_string();
        }
        let known = READABLE.iter().find(|unit| Dimension::read(unit).is_ok_and(|dimension| dimension == self));
        if let Some(unit) = known {
            return (*unit).to_string();
        }
        let side = |sign: i32| -> Vec<String> {
            let powers = BASE.iter().zip(self.powers).filter(|(_, power)| power * sign > 0);
            powers.map(|(unit, power)| format!("{unit}{}", exponent(power * sign))).collect()
        };
        let (above, below) = (side(1), side(-1));
        let above = if above.is_empty() { "1".to_string() } else { above.join(" ") };
        match below.as_slice() {
            [] => above,
            [one] => format!("{above}/{one}"),
            several => format!("{above}/({})", several.join(" ")),
        }
    }
}

/// Longest unit, bytes.
const LONGEST: usize = 100;

/// Deepest nesting of brackets in a unit.
const DEEPEST: usize = 4;

fn exponent(twelfths: i32) -> String {
    match (twelfths / WHOLE, twelfths % WHOLE) {
        (1, 0) => String::new(),
        (whole, 0) => whole.to_string(),
        _ => format!("^{}", f64::from(twelfths) / f64::from(WHOLE)),
    }
}

struct Reader<'a> {
    rest: &'a str,
    depth: usize,
}

impl Reader<'_> {
    fn takes(&mut self, symbol: char) -> bool {
        match self.rest.strip_prefix(symbol) {
            Some(rest) => {
                self.rest = rest.trim_start();
                true
            }
            None => false,
        }
    }

    fn quotient(&mut self) -> Result<Dimension, String> {
        let above = self.product()?;
        if !self.takes('/') {
            return Ok(above);
        }
        let below = self.product()?;
        if self.rest.starts_with('/') {
            return Err("a second \"/\"; put brackets around what it divides by".to_string());
        }
        Ok(above.over(below))
    }

    fn product(&mut self) -> Result<Dimension, String> {
        let mut product = self.factor()?;
        while !self.rest.is_empty() && !self.rest.starts_with(['/', ')']) {
            self.takes('*');
            product = product.times(self.factor()?);
        }
        Ok(product)
    }

    fn bracket(&mut self) -> Result<Dimension, String> {
        if self.depth == DEEPEST {
            return Err(format!("brackets more than {DEEPEST} deep"));
        }
        self.depth += 1;
        let inner = self.quotient()?;
        self.depth -= 1;
        if self.takes(')') { Ok(inner) } else { Err("a bracket is not closed".to_string()) }
    }

    fn factor(&mut self) -> Result<Dimension, String> {
        if self.takes('(') {
            let inner = self.bracket()?;
            return self.raised(inner);
        }
        if let Some(rest) = self.rest.strip_prefix("sqrt(") {
            self.rest = rest.trim_start();
            let inner = self.bracket()?;
            return inner.to_the(0.5).ok_or_else(|| "a root of it has no unit".to_string());
        }
        let letters = self.rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(self.rest.len());
        let (name, rest) = match (letters, self.rest.strip_prefix('1')) {
            (0, Some(rest)) => ("1", rest),
            _ => self.rest.split_at(letters),
        };
        let Some((_, powers)) = NAMED.iter().find(|(known, _)| *known == name) else {
            let found: String = if name.is_empty() { self.rest.chars().take(8).collect() } else { name.to_string() };
            return Err(format!("\"{found}\" is unknown"));
        };
        self.rest = rest;
        self.raised(Dimension { powers: powers.map(|power| power * WHOLE) })
    }

    /// A power directly after a factor: `2`, `^2`, `^0.5`.
    fn raised(&mut self, factor: Dimension) -> Result<Dimension, String> {
        let text = self.rest.strip_prefix('^').unwrap_or(self.rest);
        let length = text.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-')).unwrap_or(text.len());
        if length == 0 && text.len() == self.rest.len() {
            self.rest = self.rest.trim_start();
            return Ok(factor);
        }
        let power: f64 = text[..length].parse().map_err(|_| "a power is no number".to_string())?;
        self.rest = text[length..].trim_start();
        factor.to_the(power).ok_or_else(|| format!("the power {power} is too large or no twelfth"))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_and_written() {
        let same = |one: &str, other: &str| {
            assert_eq!(Dimension::read(one).unwrap(), Dimension::read(other).unwrap(), "{one} {other}");
        };
        same("N", "kg m/s2");
        same("m/(s sqrt(Pa))", "m/(s Pa^0.5)");
        same("N s/(m Pa)", "m2 s/m");
        same("Pa s2/m6", "kg m^-7");
        same("1/Pa", "m2/N");
        same("rad/s", "Hz");
        same("-", "1");
        for (unit, text) in
            [("m/(s2)", "m/s2"), ("kg/(m7)", "kg/m7"), ("sqrt(Pa)", "kg^0.5/(m^0.5 s)"), ("-", "a pure number")]
        {
            assert_eq!(Dimension::read(unit).unwrap().text(), text);
        }
    }

    #[test]
    fn what_is_no_unit_is_one_clear_line() {
        for (unit, says) in [
            ("bar", "\"bar\" is unknown"),
            ("mm", "\"mm\" is unknown"),
            ("", "\"\" is unknown"),
            ("N/s/m", "second \"/\""),
            ("N/(s", "not closed"),
            ("N)", "left over"),
            ("m^9999", "too large"),
            ("((((((m))))))", "deep"),
        ] {
            let error = Dimension::read(unit).unwrap_err().to_string();
            assert!(error.contains(says) && !error.contains('\n'), "{unit}: {error}");
        }
        assert!(Dimension::read(&"m".repeat(1000)).is_err());
    }
}
