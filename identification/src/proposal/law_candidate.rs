//! A law that is worth a fit.

use excavator_model::effects::Site;

use super::grammar::Sized;

/// A law that is worth a fit.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    /// Where it acts.
    pub site: Site,
    /// Its terms, in one row.
    pub terms: Vec<Sized>,
    /// Evidence of the regression on the equations.
    pub evidence: f64,
}

impl Candidate {
    /// Whether it is a whole law, not a sum of products.
    pub fn is_whole(&self) -> bool {
        self.terms.iter().any(|sized| sized.term.is_whole())
    }
}
