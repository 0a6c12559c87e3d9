//! Draws a curve with characters.

use excavator_study::numbers::number;

/// Rows of a chart.
const ROWS: usize = 7;

/// Draws a curve as lines of text: values on the left, the variable below. `unit` belongs to the value and `of` to the
/// variable.
pub fn chart(points: &[[f64; 2]], unit: &str, of: &str) -> Vec<String> {
    let values = points.iter().map(|point| point[1]).filter(|value| value.is_finite());
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Vec::new() };
    if !(low.is_finite() && high.is_finite()) {
        return Vec::new();
    }
    let height = if high > low { high - low } else { 1.0 };
    let row_of = |value: f64| ((high - value) / height * (ROWS - 1) as f64).round() as usize;
    let labels = [format!("{} {unit}", number(high)), format!("{} {unit}", number(low))];
    let width = labels.iter().map(String::len).max().unwrap_or_default();
    let mut lines: Vec<String> = (0..ROWS)
        .map(|row| {
            let label = match row {
                0 => &labels[0],
                row if row == ROWS - 1 => &labels[1],
                _ => "",
            };
            let marks: String = points
                .iter()
                .map(|point| match point[1] {
                    value if !value.is_finite() => ' ',
                    value if row_of(value) == row => '*',
                    _ if low < 0.0 && high > 0.0 && row_of(0.0) == row => '-',
                    _ => ' ',
                })
                .collect();
            format!("{label:>width$} |{marks}").trim_end().to_string()
        })
        .collect();
    let (left, right) = (number(first[0]), format!("{} {of}", number(last[0])));
    let gap = points.len().saturating_sub(left.len() + right.len()).max(2);
    lines.push(format!("{:width$}  {left}{}{right}", "", " ".repeat(gap)));
    lines
}

#[cfg(test)]
mod tests {
    use super::chart;

    #[test]
    fn a_straight_line_is_a_straight_line() {
        let points: Vec<[f64; 2]> = (0..=6).map(|step| [f64::from(step), f64::from(step) - 3.0]).collect();
        let lines = chart(&points, "N", "m/s");
        assert_eq!(lines[0], " 3.000 N |      *");
        assert_eq!(lines[3], "         |---*---");
        assert_eq!(lines[6], "-3.000 N |*");
        assert_eq!(lines[7], "          0  6.000 m/s");
        assert!(chart(&[], "N", "m").is_empty() && chart(&[[0.0, f64::NAN]], "N", "m").is_empty());
    }
}
