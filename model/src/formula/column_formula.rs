//! A formula over columns of numbers: `(p_hi - p_lo) * 1e5`.

use super::compile::compile_plain;
use super::error::{FormulaError, Problem};
use super::names::Names;
use super::parser::{is_word, parse};
use super::program::{Moment, Program, nowhere};
use super::symbol::Symbol;
use crate::effects::nearest;
use crate::equations::Situation;
use crate::recording::slopes;

/// An expression of columns. Its numbers have no units, its corners (`sign`, `step`, `if`) are sharp, and `rate(x)` is the
/// time derivative of a column.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnFormula {
    program: Program,
}

/// Samples on each side of a sample for its rate.
const RATE_SAMPLES: usize = 2;

impl ColumnFormula {
    /// Parses a formula. `names` are those of the columns.
    ///
    /// # Errors
    /// [`FormulaError`], in one line with the position.
    pub fn read(text: &str, names: &[String]) -> Result<ColumnFormula, FormulaError> {
        let expression = parse(text, &Names { parameters: names, states: &[], rates: true })?;
        for (symbol, at) in expression.names() {
            // A table has no machine variables.
            if let Symbol::Variable(variable, _) = symbol {
                let name = text.get(at.clone()).unwrap_or(variable.card().name).to_string();
                let suggestion = nearest(&name, names.iter().map(String::as_str));
                return Err(FormulaError::new(Problem::UnknownName { name, suggestion }, at, text));
            }
        }
        Ok(ColumnFormula { program: compile_plain(&expression, text)? })
    }

    /// Whether a formula can use this name: letters, digits and `_`, and such parts separated by dots.
    pub fn can_name(name: &str) -> bool {
        name.split('.').all(|part| part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'))
            && is_word(name.split('.').next().unwrap_or_default())
    }

    /// The indices of the columns that it uses, in order.
    pub fn inputs(&self) -> Vec<usize> {
        let mut inputs: Vec<usize> = self.program.inputs.iter().filter_map(number).collect();
        inputs.sort_unstable();
        inputs.dedup();
        inputs
    }

    /// Its value at each time, s. `columns` are those of [`ColumnFormula::inputs`], as long as `time`; a value is `NaN` if
    /// one of its inputs is.
    pub fn evaluate(&self, time: &[f64], columns: &[&[f64]]) -> Vec<f64> {
        let inputs = self.inputs();
        let width = inputs.last().map_or(0, |last| last + 1);
        let (mut now, mut rates) = (vec![f64::NAN; width], vec![f64::NAN; width]);
        let has_rate = |input: usize| self.program.inputs.contains(&Symbol::State(input));
        let slopes: Vec<Option<Vec<f64>>> = inputs
            .iter()
            .zip(columns)
            .map(|(input, column)| has_rate(*input).then(|| slopes(time, column, (0.0, RATE_SAMPLES))))
            .collect();
        let machine = nowhere();
        let situation = Situation::empty(&machine);
        let value = |sample: usize| {
            for ((input, column), slopes) in inputs.iter().zip(columns).zip(&slopes) {
                now[*input] = column.get(sample).copied().unwrap_or(f64::NAN);
                if let Some(slopes) = slopes {
                    rates[*input] = slopes.get(sample).copied().unwrap_or(f64::NAN);
                }
            }
            // A comparison with `NaN` is false, which would pass for a result.
            let is_known = |symbol: &Symbol| match symbol {
                Symbol::Parameter(number) => now[*number].is_finite(),
                Symbol::State(number) => rates[*number].is_finite(),
                Symbol::Variable(..) => false,
            };
            if !self.program.inputs.iter().all(is_known) {
                return f64::NAN;
            }
            let moment = Moment { parameters: &now, states: &rates, now: &situation, cylinder: None, opening: None };
            self.program.evaluate(&moment)
        };
        (0..time.len()).map(value).collect()
    }
}

fn number(symbol: &Symbol) -> Option<usize> {
    match symbol {
        Symbol::Parameter(number) | Symbol::State(number) => Some(*number),
        Symbol::Variable(..) => None,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn names() -> Vec<String> {
        ["t", "p_hi", "p_lo", "arm.x"].map(str::to_string).to_vec()
    }

    fn evaluate(text: &str) -> Vec<f64> {
        let time: Vec<f64> = (0..10).map(|index| 0.1 * f64::from(index)).collect();
        let columns: Vec<Vec<f64>> = vec![
            time.clone(),
            time.iter().map(|t| 3.0 + t).collect(),
            vec![1.0; 10],
            time.iter().map(|t| if *t == 0.0 { f64::NAN } else { -2.0 * t }).collect(),
        ];
        let formula = ColumnFormula::read(text, &names()).unwrap();
        let used: Vec<&[f64]> = formula.inputs().into_iter().map(|input| &columns[input][..]).collect();
        formula.evaluate(&time, &used)
    }

    #[test]
    fn columns_are_computed_from_columns() {
        assert!((evaluate("(p_hi - p_lo) * 1e5")[5] - 2.5e5).abs() < 1e-6);
        // Names of machine variables are columns here, and corners are sharp.
        assert_eq!(evaluate("if(t > 0.45, 1, -1)"), [[-1.0; 5], [1.0; 5]].concat());
        assert_eq!(evaluate("sign(t - 1e-9)")[..2], [-1.0, 1.0]);
        assert!((evaluate("rate(arm.x) + 0*arm.x")[4] + 2.0).abs() < 1e-9);
        let gap = evaluate("max(arm.x + p_lo, 0) + rate(t)");
        assert!(gap[1..].iter().all(|value| value.is_finite()), "{gap:?}");
        assert!(evaluate("2^3").iter().all(|value| *value == 8.0));
    }

    #[test]
    fn what_is_not_measured_gives_no_value() {
        assert!(evaluate("arm.x * 2")[0].is_nan() && evaluate("arm.x * 2")[1].is_finite());
        assert!(evaluate("if(arm.x < 0, 1, 2)")[0].is_nan(), "{:?}", evaluate("if(arm.x < 0, 1, 2)"));
        for text in
            ["min(arm.x, 0)", "max(0, arm.x)", "clamp(arm.x, -1, 1)", "step(arm.x)", "abs(arm.x)", "sign(arm.x)"]
        {
            assert!(evaluate(text)[0].is_nan(), "{text}: {:?}", evaluate(text));
        }
    }

    #[test]
    fn unknown_names_are_told_with_the_nearest_column() {
        let complaint = |text: &str| ColumnFormula::read(text, &names()).unwrap_err().to_string();
        assert!(
            complaint("p_hj * 2").contains("unknown name \"p_hj\" (did you mean \"p_hi\"?)"),
            "{}",
            complaint("p_hj")
        );
        assert!(complaint("p_cap").contains("unknown name \"p_cap\""), "{}", complaint("p_cap"));
        assert!(complaint("rate(2)").contains("a name, as in rate(x)"), "{}", complaint("rate(2)"));
        assert!(complaint("p_hi > 2").contains("comparison"), "{}", complaint("p_hi > 2"));
        assert!(complaint("").contains("expected a number"), "{}", complaint(""));
        assert!(ColumnFormula::can_name("arm.x") && ColumnFormula::can_name("p_1"));
        for name in ["", "1p", "Druck A", "p-1", ".x"] {
            assert!(!ColumnFormula::can_name(name), "{name}");
        }
    }
}
