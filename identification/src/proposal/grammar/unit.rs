//! Units of products, and of the coefficient that gives a product the unit of its row.

use excavator_model::formula::Row;

/// A unit as a product of names with powers.
pub(super) type Unit = &'static [(&'static str, f64)];

pub(super) const PURE: Unit = &[];
pub(super) const LENGTH: Unit = &[("m", 1.0)];
pub(super) const LENGTH_2: Unit = &[("m", 2.0)];
pub(super) const LENGTH_3: Unit = &[("m", 3.0)];
pub(super) const SPEED: Unit = &[("m", 1.0), ("s", -1.0)];
pub(super) const SPEED_2: Unit = &[("m", 2.0), ("s", -2.0)];
pub(super) const SPEED_TIMES_LENGTH: Unit = &[("m", 2.0), ("s", -1.0)];
pub(super) const RATE: Unit = &[("s", -1.0)];
pub(super) const RATE_2: Unit = &[("s", -2.0)];
pub(super) const PRESSURE: Unit = &[("Pa", 1.0)];
pub(super) const PRESSURE_2: Unit = &[("Pa", 2.0)];
pub(super) const ROOT_OF_PRESSURE: Unit = &[("Pa", 0.5)];
pub(super) const AREA: Unit = &[("m", 2.0)];
pub(super) const AREA_2: Unit = &[("m", 4.0)];
pub(super) const AREA_3: Unit = &[("m", 6.0)];
pub(super) const ROOT_OF_SPEED: Unit = &[("m", 0.5), ("s", -0.5)];
pub(super) const ACCELERATION: Unit = &[("m", 1.0), ("s", -2.0)];
pub(super) const FORCE: Unit = &[("N", 1.0)];
pub(super) const TIME: Unit = &[("s", 1.0)];

/// Unit of the coefficient that gives a product of `factors` the unit of `row`.
pub(super) fn of_coefficient(row: Row, factors: &[Unit]) -> String {
    let whole: Unit = match row {
        Row::PistonForce => &[("N", 1.0)],
        Row::JointTorque => &[("N", 1.0), ("m", 1.0)],
        row if row.is_an_opening() => AREA,
        _ => &[("m", 3.0), ("s", -1.0)],
    };
    let mut powers: Vec<(&str, f64)> = whole.to_vec();
    for (name, power) in factors.iter().flat_map(|factor| factor.iter()) {
        match powers.iter_mut().find(|(known, _)| known == name) {
            Some((_, known)) => *known -= power,
            None => powers.push((name, -power)),
        }
    }
    let side = |sign: f64| -> Vec<String> {
        let own = powers.iter().filter(|(_, power)| power * sign > 0.0);
        own.map(|(name, power)| format!("{name}{}", exponent(power.abs()))).collect()
    };
    match (side(1.0).join(" "), side(-1.0).as_slice()) {
        (above, []) if above.is_empty() => "-".to_string(),
        (above, []) => above,
        (above, below) => {
            let above = if above.is_empty() { "1".to_string() } else { above };
            let below = if below.len() == 1 { below[0].clone() } else { format!("({})", below.join(" ")) };
            format!("{above}/{below}")
        }
    }
}

fn exponent(power: f64) -> String {
    match power {
        1.0 => String::new(),
        whole if whole.fract() == 0.0 => format!("{whole}"),
        broken => format!("^{broken}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_have_the_units_of_textbooks() {
        assert_eq!(of_coefficient(Row::PistonForce, &[SPEED, PRESSURE]), "N s/(m Pa)");
        assert_eq!(of_coefficient(Row::PistonForce, &[LENGTH, PURE]), "N/m");
        assert_eq!(of_coefficient(Row::CapFlow, &[PRESSURE_2]), "m3/(s Pa2)");
        assert_eq!(of_coefficient(Row::CapFlow, &[ROOT_OF_PRESSURE]), "m3/(s Pa^0.5)");
        assert_eq!(of_coefficient(Row::Opening, &[AREA, PRESSURE]), "1/Pa");
        assert_eq!(of_coefficient(Row::Opening, &[AREA]), "-");
    }
}
