//! User-defined laws, written as text.
//!
//! A formula is parsed (`parser`), checked for units and compiled (`compile`), and evaluated with plain numbers or dual
//! numbers (`program`). So one text is enough for simulation, regressor, power and sensitivities, like the code of a built-in
//! effect.

mod check;
mod column_formula;
mod compile;
mod condition;
mod corner;
mod dimension;
mod error;
mod expression;
mod function;
mod law;
mod linearity;
mod names;
mod parser;
mod power;
mod program;
mod read;
mod row;
mod symbol;
mod table;
mod text;
mod token;
mod variable;

pub use check::{CheckProblem, Checked, Curve, check};
pub use column_formula::ColumnFormula;
pub use condition::Condition;
pub use dimension::{Dimension, UnitError};
pub use error::{FormulaError, Problem};
pub use law::Law;
pub use read::{LawError, LawProblem};
pub use row::{ROWS, Row, RowCard};
pub use text::{FormulaText, ParameterText, StateText};
pub use variable::variables;
