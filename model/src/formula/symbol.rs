//! What a name in a formula means.

use super::variable::{VARIABLES, Variable};

/// The meaning of a name.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Symbol {
    /// The effect's parameter with this index.
    Parameter(usize),
    /// The effect's state with this index.
    State(usize),
    /// A variable of the effect's own place, or of the cylinder with this name.
    Variable(Variable, Option<String>),
}

impl Symbol {
    /// The variable with this name, `v` or `boom.v`.
    pub fn variable(name: &str) -> Option<Symbol> {
        let (cylinder, own) = name.rsplit_once('.').map_or((None, name), |(cylinder, own)| (Some(cylinder), own));
        let variable = VARIABLES.iter().find(|card| card.name == own)?.variable;
        if cylinder.is_some_and(|cylinder| cylinder.is_empty() || !variable.is_of_a_cylinder()) {
            return None;
        }
        Some(Symbol::Variable(variable, cylinder.map(str::to_string)))
    }

    /// Whether a variable has this name.
    pub fn is_variable(name: &str) -> bool {
        VARIABLES.iter().any(|card| card.name == name)
    }
}
