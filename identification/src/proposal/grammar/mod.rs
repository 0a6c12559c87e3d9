//! Generates all terms that are tried: products of physical factors in one row of the equations.

mod factor;
mod flows;
mod forces;
mod quantity;
mod shapes;
mod term;
mod unit;
mod valve;

use excavator_model::formula::Row;

pub(super) use factor::{Factor, ONE};
#[cfg(test)]
pub(super) use flows::PAST_THE_PISTON;
#[cfg(test)]
pub(super) use forces::{GROWING, REMEMBERING, RESISTING};
pub(super) use term::{COEFFICIENT, PROPOSED, Sized, Term, law_text, rounded};
#[cfg(test)]
pub(super) use valve::{OPENING, SHIFTING};

/// Every term of the grammar.
pub(super) fn terms() -> Vec<Term> {
    let mut terms = Vec::new();
    forces::forces(&mut terms);
    flows::flows(&mut terms);
    valve::valve(&mut terms);
    terms
}

/// Adds each factor alone, and its product with each of the others.
fn with_products(terms: &mut Vec<Term>, row: Row, own: &'static [Factor], others: &'static [Factor]) {
    for one in own {
        terms.push(Term::of(row, one));
        let fitting = others.iter().filter(|other| one_shape_at_most(one, other));
        terms.extend(fitting.map(|other| Term::product(row, one, other)));
    }
}

/// Whether at most one of two factors has a shape. Two shapes need a search in several parameters, which a grid of
/// start values cannot replace.
fn one_shape_at_most(one: &Factor, other: &Factor) -> bool {
    one.shapes.is_empty() || other.shapes.is_empty()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use super::*;
    use excavator_model::formula::Law;

    #[test]
    fn every_term_is_a_law_that_can_be_read() {
        let mut names = std::collections::BTreeSet::new();
        let terms = terms();
        for term in &terms {
            let shapes = vec![0.01; term.parameters() - 1];
            let coefficient = if term.is_whole() { 1.5 } else { -1.5 };
            let sized = Sized { term: *term, shapes, coefficient, cylinder: "arm".into() };
            let text = law_text(&[sized], "").unwrap();
            Law::read(&text).unwrap_or_else(|error| panic!("{}: {error}", text.formula));
            assert!(names.insert(text.name.clone()), "{} twice", text.name);
        }
        assert!(terms.len() > 200, "{}", terms.len());
    }
}
