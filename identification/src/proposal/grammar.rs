//! All terms that are tried.

use excavator_model::formula::Row;

use super::factor::{
    ABS_SPEED, AT_CYLINDER, CAP_TO_TANK, CAP_WALL, EDGE, FROM_CAP, FROM_PUMP, FROM_ROD, Factor, GROWING, OPENING,
    PAST_THE_PISTON, PUMP_TO_CAP, PUMP_TO_ROD, PUMP_WALL, PUSHING, REMEMBERING, RESISTING, ROD_TO_TANK, ROD_WALL,
    SHIFTING, TURNING, WAVE,
};
use super::term::Term;

/// Every term of the grammar.
pub(super) fn terms() -> Vec<Term> {
    let mut terms = Vec::new();
    forces(&mut terms);
    leaks(&mut terms);
    valve(&mut terms);
    terms
}

fn with_products(terms: &mut Vec<Term>, row: Row, own: &'static [Factor], others: &'static [Factor]) {
    for one in own {
        terms.push(Term::of(row, one));
        // A shape in both factors costs a search in three numbers, which no start on a grid replaces.
        let fitting = others.iter().filter(|other| one.shapes.is_empty() || other.shapes.is_empty());
        terms.extend(fitting.map(|other| Term::product(row, one, other)));
    }
}

fn forces(terms: &mut Vec<Term>) {
    with_products(terms, Row::PistonForce, &RESISTING, &GROWING);
    let row = Row::PistonForce;
    for push in &PUSHING {
        terms.push(Term::of(row, push));
        let along = GROWING.iter().filter(|other| matches!(other.word, "beyond" | "below" | "around" | "time"));
        let along = along.filter(|other| push.shapes.is_empty() || other.shapes.is_empty());
        terms.extend(along.map(|other| Term::product(row, push, other)));
        if push.text.starts_with("(p_") || push.text.starts_with("p_") {
            let position = GROWING.iter().filter(|other| other.word.ends_with("position"));
            terms.extend(position.map(|other| Term::product(row, push, other)));
        }
    }
    terms.push(Term::product(row, &RESISTING[0], &WAVE));
    terms.extend(REMEMBERING.iter().map(|one| Term::of(row, one)));
    terms.extend(TURNING.iter().map(|turning| Term::of(Row::JointTorque, turning)));
}

fn leaks(terms: &mut Vec<Term>) {
    with_products(terms, Row::PistonLeak, &PAST_THE_PISTON, &GROWING);
    for (row, own) in [(Row::PistonLeak, &PAST_THE_PISTON[..]), (Row::CapFlow, &FROM_CAP), (Row::RodFlow, &FROM_ROD)] {
        let plain = own.iter().filter(|one| one.shapes.is_empty());
        terms.extend(plain.flat_map(|one| [Term::product(row, one, &WAVE), Term::product(row, one, &ABS_SPEED)]));
    }
    let along = |word: &str| matches!(word, "position" | "abs_position" | "beyond" | "below" | "time" | "abs_opening");
    for (row, own) in [(Row::CapFlow, &FROM_CAP), (Row::RodFlow, &FROM_ROD)] {
        for one in own {
            terms.push(Term::of(row, one));
            let others = GROWING.iter().filter(|other| along(other.word));
            let others = others.filter(|other| one.shapes.is_empty() || other.shapes.is_empty());
            terms.extend(others.map(|other| Term::product(row, one, other)));
        }
    }
    for (row, walls) in [(Row::CapFlow, &CAP_WALL), (Row::RodFlow, &ROD_WALL)] {
        terms.extend(walls.iter().map(|wall| Term::of(row, wall)));
    }
    terms.extend(PUMP_WALL.iter().chain(&AT_CYLINDER).map(|one| Term::of(Row::PumpLeak, one)));
    for one in &FROM_PUMP {
        terms.extend(AT_CYLINDER.iter().map(|other| Term::product(Row::PumpLeak, one, other)));
        terms.push(Term::of(Row::PumpLeak, one));
        let time = GROWING.iter().filter(|other| other.word == "time");
        terms.extend(time.map(|other| Term::product(Row::PumpLeak, one, other)));
    }
}

fn valve(terms: &mut Vec<Term>) {
    let ways = [
        (Row::PumpToCap, &PUMP_TO_CAP),
        (Row::PumpToRod, &PUMP_TO_ROD),
        (Row::CapToTank, &CAP_TO_TANK),
        (Row::RodToTank, &ROD_TO_TANK),
    ];
    for (row, own) in ways {
        for one in own {
            terms.push(Term::of(row, one));
            terms.extend(EDGE.iter().map(|edge| Term::product(row, one, edge)));
        }
    }
    with_products(terms, Row::Opening, &OPENING, &SHIFTING);
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use super::super::term::{Sized, law_text};
    use super::*;
    use excavator_model::formula::Law;

    #[test]
    fn every_term_is_a_law_that_can_be_read() {
        let mut names = std::collections::BTreeSet::new();
        let terms = terms();
        for term in &terms {
            let shapes = vec![0.01; term.parameters() - 1];
            let text =
                law_text(&[Sized { term: *term, shapes, coefficient: -1.5, cylinder: "arm".into() }], "").unwrap();
            Law::read(&text).unwrap_or_else(|error| panic!("{}: {error}", text.formula));
            assert!(names.insert(text.name.clone()), "{} twice", text.name);
        }
        assert!(terms.len() > 200, "{}", terms.len());
    }
}
