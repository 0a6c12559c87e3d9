//! Describes the missing physics as a curve without an explanation: a table.

use std::collections::BTreeMap;

use excavator_model::formula::{FormulaText, ParameterText};

use super::grammar::rounded;
use crate::diagnosis::Unexplained;

/// Number of knots in a table: enough for a dead zone and a drop, few enough that each has many samples.
const KNOTS: usize = 12;

/// The curve of a residual as a law. Returns `None` if no row of the equations accepts it.
pub(super) fn table_law(left: &Unexplained) -> Option<FormulaText> {
    let (place, equation) = left.equation.split_once('.')?;
    let (row, sign) = match equation {
        "motion" => ("joint_torque", 1.0),
        "cap_continuity" => ("cap_flow", 1.0),
        "rod_continuity" => ("rod_flow", 1.0),
        _ => ("pump_leak", -1.0),
    };
    let is_pump = place == "pump";
    let variable = match &*left.variable {
        "command" => "u",
        "speed" => "v",
        "position" => "s",
        "cap_pressure" => "p_cap",
        "rod_pressure" => "p_rod",
        "pump_pressure" => "p_pump",
        "time" => "t",
        _ => return None,
    };
    // The pump line has no cylinder of its own.
    if is_pump && !matches!(variable, "p_pump" | "t") {
        return None;
    }
    let knots = knots(&left.curve);
    let scale = rounded(knots.iter().map(|(_, y)| y.abs()).fold(0.0, f64::max));
    if knots.len() < 2 || scale <= 0.0 {
        return None;
    }
    let list = |values: Vec<f64>| values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(", ");
    let (x, y): (Vec<f64>, Vec<f64>) = knots.iter().map(|(x, y)| (*x, sign * y / scale)).unzip();
    let unit = if row == "joint_torque" { "N m" } else { "m3/s" };
    let coefficient = ParameterText {
        unit: unit.to_string(),
        minimum: Some(0.0),
        maximum: Some(rounded(10.0 * scale)),
        start: vec![scale],
        value: None,
        known: false,
        meaning: "largest value of the curve".to_string(),
    };
    Some(FormulaText {
        name: format!("curve_of_{row}_over_{}", left.variable),
        acts_on: row.to_string(),
        formula: format!("k*table({variable}, [{}], [{}])", list(x), list(y)),
        summary: format!(
            "What the equations lack, as a table over the {}: a measured curve, and no law.",
            words(&left.variable)
        ),
        source: super::proposals::CURVE.to_string(),
        shows: String::new(),
        experiment: String::new(),
        parameters: BTreeMap::from([("k".to_string(), coefficient)]),
        states: BTreeMap::new(),
    })
}

fn words(variable: &str) -> String {
    variable.replace('_', " ")
}

/// Merges neighbouring points of the curve into `KNOTS` knots in rising order.
fn knots(curve: &[[f64; 3]]) -> Vec<(f64, f64)> {
    let points: Vec<[f64; 3]> =
        curve.iter().copied().filter(|point| point.iter().all(|value| value.is_finite())).collect();
    let size = points.len().div_ceil(KNOTS).max(1);
    let mean =
        |points: &[[f64; 3]], index: usize| points.iter().map(|point| point[index]).sum::<f64>() / points.len() as f64;
    let mut knots: Vec<(f64, f64)> =
        points.chunks(size).map(|points| (rounded(mean(points, 0)), mean(points, 1))).collect();
    knots.dedup_by(|next, last| next.0 <= last.0);
    knots
}

/// Formats a number for a formula.
fn number(value: f64) -> String {
    let value = rounded(value);
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::formula::Law;

    fn left(equation: &str, variable: &'static str) -> Unexplained {
        let curve =
            (0..24).map(|index| [f64::from(index) * 0.01 - 0.1, f64::from(index * index) - 90.0, 1.0]).collect();
        Unexplained {
            equation: equation.into(),
            variable: variable.into(),
            share_of_residual: 0.9,
            follows_variable: true,
            differs_in_form: false,
            curve,
            unit: "N m".into(),
        }
    }

    #[test]
    fn a_curve_is_a_law_that_can_be_read() {
        for (equation, variable) in [
            ("arm.motion", "speed"),
            ("arm.cap_continuity", "command"),
            ("arm.rod_continuity", "time"),
            ("pump.continuity", "pump_pressure"),
        ] {
            let text = table_law(&left(equation, variable)).unwrap();
            Law::read(&text).unwrap_or_else(|error| unreachable!("{}: {error}", text.formula));
        }
        assert!(table_law(&left("pump.continuity", "speed")).is_none());
        assert!(table_law(&Unexplained { curve: Vec::new(), ..left("arm.motion", "speed") }).is_none());
    }
}
