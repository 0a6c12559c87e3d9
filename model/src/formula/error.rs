//! Errors in a formula.

use std::ops::Range;

/// An invalid formula, with the position of the error.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{problem}, at column {}{}", at.start + 1, near(excerpt))]
#[non_exhaustive]
pub struct FormulaError {
    /// The error.
    pub problem: Problem,
    /// Bytes of the formula that the error refers to.
    pub at: Range<usize>,
    /// The beginning of those bytes.
    pub excerpt: String,
}

/// An error in a formula.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// An invalid character.
    #[error("'{0}' is no part of a formula")]
    Character(char),
    /// A number that cannot be read or is too large for a double.
    #[error("not a finite number")]
    Number,
    /// Another token is required here.
    #[error("expected {0}")]
    Expected(&'static str),
    /// Text after the end of the formula.
    #[error("expected an operator or the end")]
    Trailing,
    /// Two comparisons in a row.
    #[error("comparisons cannot be chained; write if(a < b, if(b < c, ...), ...)")]
    ChainedComparison,
    /// A comparison outside of `if`.
    #[error("a comparison stands only in if(condition, a, b)")]
    ComparisonOutside,
    /// A name that is neither a variable nor a parameter.
    #[error("unknown name \"{name}\"{}", did_you_mean(suggestion))]
    UnknownName {
        /// The name.
        name: String,
        /// The nearest known name.
        suggestion: Option<String>,
    },
    /// A name that is not a function.
    #[error("unknown function \"{name}\"{}", did_you_mean(suggestion))]
    UnknownFunction {
        /// The name.
        name: String,
        /// The nearest function.
        suggestion: Option<String>,
    },
    /// A function with too few or too many arguments.
    #[error("{function} takes {wanted}, not {found}")]
    Arguments {
        /// The function.
        function: &'static str,
        /// Description of the required arguments.
        wanted: &'static str,
        /// How many there are.
        found: usize,
    },
    /// A table with invalid knots.
    #[error("a table needs at least two knots, as many values, and knots that rise")]
    Table,
    /// A variable that is not available in this row.
    #[error("{name} is not known here: {reason}")]
    Unavailable {
        /// The variable.
        name: String,
        /// The reason.
        reason: &'static str,
    },
    /// Two parts of a sum, or of a comparison, in different units.
    #[error("cannot {verb} {left} and {right}")]
    Mismatch {
        /// "add", "subtract", "compare" or "choose between".
        verb: &'static str,
        /// Unit of the first.
        left: String,
        /// Unit of the other.
        right: String,
    },
    /// An argument that must be a pure number.
    #[error("{what} must be a pure number, but is in {found}; divide it by a parameter with this unit")]
    NotPure {
        /// The argument.
        what: String,
        /// Its unit.
        found: String,
    },
    /// A power of something with a unit whose exponent is not a number.
    #[error("a quantity in {0} can be raised only to a constant number, because the unit of the result must be known")]
    VariableExponent(String),
    /// The formula has a different unit from its row.
    #[error("the formula is in {found}, but {row} is in {wanted}")]
    WrongRow {
        /// The row.
        row: String,
        /// Its unit.
        wanted: String,
        /// The formula's unit.
        found: String,
    },
    /// The formula is too long.
    #[error("longer than {0} characters")]
    TooLong(usize),
    /// The formula is nested too deeply.
    #[error("nested more than {0} deep")]
    TooDeep(usize),
    /// The formula has too many operations.
    #[error("more than {0} operations")]
    TooManyOperations(usize),
}

/// Characters of an excerpt.
const EXCERPT: usize = 24;

impl FormulaError {
    /// `problem` at these bytes of `text`.
    pub(super) fn new(problem: Problem, at: Range<usize>, text: &str) -> Self {
        let rest = text.get(at.start..at.end.max(at.start)).unwrap_or_default();
        let mut excerpt: String = rest.chars().take(EXCERPT).collect();
        if excerpt.len() < rest.len() {
            excerpt.push_str("...");
        }
        FormulaError { problem, at, excerpt }
    }
}

fn near(excerpt: &str) -> String {
    if excerpt.is_empty() { String::new() } else { format!(" (\"{excerpt}\")") }
}

fn did_you_mean(suggestion: &Option<String>) -> String {
    suggestion.as_ref().map_or(String::new(), |name| format!(" (did you mean \"{name}\"?)"))
}
