//! Resolves the names in a formula.

use super::symbol::Symbol;
use super::variable::VARIABLES;

/// The parameters and states of an effect; its formulas also use the variables of the language.
#[derive(Debug, Clone, Copy)]
pub(super) struct Names<'a> {
    pub parameters: &'a [String],
    pub states: &'a [String],
    /// Whether `rate(x)` is the state with the index of the parameter `x`: for formulas over columns.
    pub rates: bool,
}

impl<'a> Names<'a> {
    /// The meaning of a name; `None` if it is unknown.
    pub fn find(&self, name: &str) -> Option<Symbol> {
        let position = |names: &[String]| names.iter().position(|known| known == name);
        position(self.parameters)
            .map(Symbol::Parameter)
            .or_else(|| position(self.states).map(Symbol::State))
            .or_else(|| Symbol::variable(name))
    }

    /// All names, for suggestions.
    pub fn all(&self) -> impl Iterator<Item = &'a str> {
        let own = self.parameters.iter().chain(self.states).map(String::as_str);
        own.chain(VARIABLES.iter().map(|card| card.name))
    }
}
