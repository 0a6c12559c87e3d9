//! Numbers and texts of plots as JSON in a page.

/// JSON text that cannot close its script element.
pub(super) fn text(words: &str) -> String {
    serde_json::Value::from(words).to_string().replace('<', "\\u003c")
}

/// JSON array of the kept values with five significant digits; values that are not finite are `null`.
pub(super) fn array(values: &[f64], factor: f64, kept: &[usize]) -> String {
    let entries: Vec<String> = kept
        .iter()
        .map(|&index| match values.get(index).map(|value| value * factor) {
            Some(value) if value.is_finite() => shortest(&format!("{value:.4e}")),
            _ => "null".to_string(),
        })
        .collect();
    format!("[{}]", entries.join(","))
}

/// The same number in the fewest characters that JSON allows. Plain digits of 1e-30 would fill a line.
pub(super) fn shortest(decimal: &str) -> String {
    let Ok(value) = decimal.parse::<f64>() else { return "null".to_string() };
    let (plain, scientific) = (value.to_string(), format!("{value:e}"));
    if scientific.len() < plain.len() { scientific } else { plain }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_short_and_gaps_are_null() {
        assert_eq!(
            array(&[1.234_567_8, f64::NAN, f64::INFINITY, -0.000_012_345_67], 1.0, &[0, 1, 2, 3]),
            "[1.2346,null,null,-1.2346e-5]"
        );
        assert_eq!(array(&[1e-30, 0.0, 1500.0, -2e9], 1.0, &[0, 1, 2, 3]), "[1e-30,0,1500,-2e9]");
        assert_eq!(text("a</script>\""), r#""a\u003c/script>\"""#);
    }
}
