//! Finds the parameters in which a formula is linear.

use super::expression::{Expression, Node, Operator};
use super::symbol::Symbol;

/// Which of `count` parameters form a set in which the formula is jointly linear: earlier ones take precedence.
pub(super) fn linear_parameters(formula: &Expression, count: usize) -> Vec<bool> {
    let mut chosen = vec![false; count];
    for number in 0..count {
        chosen[number] = true;
        chosen[number] = degree(formula, &chosen) <= Degree::Linear;
    }
    chosen
}

/// How a formula depends on the chosen parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Degree {
    Constant,
    Linear,
    Other,
}

fn degree(expression: &Expression, chosen: &[bool]) -> Degree {
    let of = |part: &Expression| degree(part, chosen);
    // Any other operation is not linear in the parameters that it depends on.
    let other = |parts: &[&Expression]| {
        let is_constant = parts.iter().all(|part| of(part) == Degree::Constant);
        if is_constant { Degree::Constant } else { Degree::Other }
    };
    match &expression.node {
        Node::Number(_) => Degree::Constant,
        Node::Name(Symbol::Parameter(number)) if chosen.get(*number) == Some(&true) => Degree::Linear,
        Node::Name(_) => Degree::Constant,
        Node::Negative(inner) => of(inner),
        Node::Binary(Operator::Add | Operator::Subtract, left, right) => of(left).max(of(right)),
        Node::Binary(Operator::Multiply, left, right) => match (of(left), of(right)) {
            (Degree::Constant, other) | (other, Degree::Constant) => other,
            _ => Degree::Other,
        },
        Node::Binary(Operator::Divide, above, below) => match of(below) {
            Degree::Constant => of(above),
            _ => Degree::Other,
        },
        Node::Binary(Operator::Power, base, exponent) => other(&[base, exponent]),
        Node::Call(_, arguments) => other(&arguments.iter().collect::<Vec<_>>()),
        Node::Table(x, _, _) => other(&[x]),
        Node::If { less, more, then, otherwise } => match other(&[less, more]) {
            Degree::Constant => of(then).max(of(otherwise)),
            _ => Degree::Other,
        },
    }
}
