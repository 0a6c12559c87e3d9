//! A formula as a tree.

use std::ops::Range;

use super::function::Function;
use super::symbol::Symbol;

/// A part of a formula and its position in the text.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Expression {
    pub node: Node,
    pub at: Range<usize>,
}

impl Expression {
    /// Every name in it and its position.
    pub fn names(&self) -> Vec<(&Symbol, Range<usize>)> {
        let (mut found, mut waiting) = (Vec::new(), vec![self]);
        while let Some(part) = waiting.pop() {
            match &part.node {
                Node::Number(_) => {}
                Node::Name(symbol) => found.push((symbol, part.at.clone())),
                Node::Negative(inner) | Node::Table(inner, _, _) => waiting.push(inner),
                Node::Binary(_, left, right) => waiting.extend([&**left, right]),
                Node::Call(_, arguments) => waiting.extend(arguments),
                Node::If { less, more, then, otherwise } => waiting.extend([&**less, more, then, otherwise]),
            }
        }
        found
    }
}

/// The kind of a part of a formula.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Node {
    Number(f64),
    Name(Symbol),
    Negative(Box<Expression>),
    Binary(Operator, Box<Expression>, Box<Expression>),
    Call(Function, Vec<Expression>),
    /// `table(x, knots, values)`.
    Table(Box<Expression>, Vec<f64>, Vec<f64>),
    /// `if(less < more, then, otherwise)`.
    If {
        less: Box<Expression>,
        more: Box<Expression>,
        then: Box<Expression>,
        otherwise: Box<Expression>,
    },
}

/// A binary operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}
