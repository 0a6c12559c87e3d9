//! Parses tokens to a tree, with the usual precedence: `-x^2` is `-(x^2)`, `2^3^2` is `2^(3^2)`.

use std::ops::Range;

use super::error::{FormulaError, Problem};
use super::expression::{Expression, Node, Operator};
use super::function::{FUNCTIONS, Function};
use super::names::Names;
use super::symbol::Symbol;
use super::token::{Placed, Token, tokens};
use crate::effects::nearest;

/// Deepest nesting. Each level takes a few hundred bytes of stack.
const DEEPEST: usize = 64;

/// Most operations. A law of the catalogue has five to twenty.
const MOST_OPERATIONS: usize = 400;

/// Parses a formula. `names` are the parameters, states and variables that it may use.
pub(super) fn parse(text: &str, names: &Names<'_>) -> Result<Expression, FormulaError> {
    let mut parser = Parser { text, tokens: tokens(text)?, next: 0, depth: 0, operations: 0, names };
    let expression = parser.sum()?;
    match parser.token() {
        Token::End => Ok(expression),
        Token::Less | Token::LessOrEqual | Token::Greater | Token::GreaterOrEqual => {
            Err(parser.error(Problem::ComparisonOutside))
        }
        _ => Err(parser.error(Problem::Trailing)),
    }
}

/// Parses a comparison, as in `abs(v) > 0.002`: returns the side that is larger if the comparison holds, then the other.
pub(super) fn parse_condition(text: &str, names: &Names<'_>) -> Result<[Expression; 2], FormulaError> {
    let mut parser = Parser { text, tokens: tokens(text)?, next: 0, depth: 0, operations: 0, names };
    let sides = parser.comparison("a comparison: <, <=, > or >=")?;
    match parser.token() {
        Token::End => Ok(sides),
        _ => Err(parser.error(Problem::Trailing)),
    }
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Placed>,
    next: usize,
    depth: usize,
    operations: usize,
    names: &'a Names<'a>,
}

impl Parser<'_> {
    fn token(&self) -> &Token {
        &self.tokens[self.next].token
    }

    fn at(&self) -> Range<usize> {
        self.tokens[self.next].at.clone()
    }

    fn error(&self, problem: Problem) -> FormulaError {
        self.error_at(problem, self.at())
    }

    fn error_at(&self, problem: Problem, at: Range<usize>) -> FormulaError {
        FormulaError::new(problem, at, self.text)
    }

    /// Advances to the next token; stays at the end.
    fn take(&mut self) {
        self.next = (self.next + 1).min(self.tokens.len() - 1);
    }

    fn takes(&mut self, symbol: char) -> bool {
        let is_next = *self.token() == Token::Symbol(symbol);
        if is_next {
            self.take();
        }
        is_next
    }

    fn expect(&mut self, symbol: char, what: &'static str) -> Result<(), FormulaError> {
        if self.takes(symbol) { Ok(()) } else { Err(self.error(Problem::Expected(what))) }
    }

    /// Runs `part` one level deeper.
    fn deeper<T>(&mut self, part: impl FnOnce(&mut Self) -> Result<T, FormulaError>) -> Result<T, FormulaError> {
        if self.depth == DEEPEST {
            return Err(self.error(Problem::TooDeep(DEEPEST)));
        }
        self.depth += 1;
        let result = part(self);
        self.depth -= 1;
        result
    }

    /// Counts an operation.
    fn count(&mut self) -> Result<(), FormulaError> {
        self.operations += 1;
        if self.operations > MOST_OPERATIONS {
            Err(self.error(Problem::TooManyOperations(MOST_OPERATIONS)))
        } else {
            Ok(())
        }
    }

    fn sum(&mut self) -> Result<Expression, FormulaError> {
        self.deeper(|parser| parser.left_to_right(&[('+', Operator::Add), ('-', Operator::Subtract)], Parser::product))
    }

    fn product(&mut self) -> Result<Expression, FormulaError> {
        self.left_to_right(&[('*', Operator::Multiply), ('/', Operator::Divide)], Parser::signed)
    }

    fn left_to_right(
        &mut self,
        operators: &[(char, Operator)],
        part: fn(&mut Self) -> Result<Expression, FormulaError>,
    ) -> Result<Expression, FormulaError> {
        let mut left = part(self)?;
        while let Some(&(_, operator)) = operators.iter().find(|(symbol, _)| *self.token() == Token::Symbol(*symbol)) {
            self.take();
            self.count()?;
            left = binary(operator, left, part(self)?);
        }
        Ok(left)
    }

    /// A sign has lower precedence than a power: `-x^2` is `-(x^2)`.
    fn signed(&mut self) -> Result<Expression, FormulaError> {
        let begin = self.at().start;
        if self.takes('-') {
            let inner = self.deeper(Parser::signed)?;
            let at = begin..inner.at.end;
            return Ok(Expression { node: Node::Negative(Box::new(inner)), at });
        }
        if self.takes('+') {
            return self.deeper(Parser::signed);
        }
        self.power()
    }

    /// Powers are right-associative, and an exponent may have a sign.
    fn power(&mut self) -> Result<Expression, FormulaError> {
        let base = self.atom()?;
        if !self.takes('^') {
            return Ok(base);
        }
        self.count()?;
        let exponent = self.deeper(Parser::signed)?;
        Ok(binary(Operator::Power, base, exponent))
    }

    fn atom(&mut self) -> Result<Expression, FormulaError> {
        let at = self.at();
        match self.token().clone() {
            Token::Number(value) => {
                self.take();
                Ok(Expression { node: Node::Number(value), at })
            }
            Token::Name(name) => {
                self.take();
                if self.takes('(') { self.call(&name, at) } else { self.name(&name, at) }
            }
            Token::Symbol('(') => {
                self.take();
                let inner = self.sum()?;
                self.expect(')', "\")\"")?;
                Ok(inner)
            }
            _ => Err(self.error(Problem::Expected("a number, a name or \"(\""))),
        }
    }

    fn name(&self, name: &str, at: Range<usize>) -> Result<Expression, FormulaError> {
        match self.names.find(name) {
            Some(symbol) => Ok(Expression { node: Node::Name(symbol), at }),
            None if FUNCTIONS.iter().any(|(function, _)| *function == name) => {
                Err(self.error(Problem::Expected("\"(\" after the name of a function")))
            }
            None => {
                let suggestion = nearest(name, self.names.all());
                Err(self.error_at(Problem::UnknownName { name: name.to_string(), suggestion }, at))
            }
        }
    }

    /// A call, after its "(".
    fn call(&mut self, name: &str, at: Range<usize>) -> Result<Expression, FormulaError> {
        let begin = at.start;
        self.count()?;
        let node = match name {
            "table" => self.table()?,
            "if" => self.choice()?,
            "rate" if self.names.rates => self.rate()?,
            _ => {
                let Some(&(_, function)) = FUNCTIONS.iter().find(|(known, _)| *known == name) else {
                    let rate = self.names.rates.then_some("rate");
                    let known = FUNCTIONS.iter().map(|(name, _)| *name).chain(["table", "if"]).chain(rate);
                    let suggestion = nearest(name, known);
                    return Err(self.error_at(Problem::UnknownFunction { name: name.to_string(), suggestion }, at));
                };
                self.arguments(function)?
            }
        };
        let end = self.tokens[self.next - 1].at.end;
        Ok(Expression { node, at: begin..end })
    }

    fn arguments(&mut self, function: Function) -> Result<Node, FormulaError> {
        let mut arguments = Vec::new();
        if *self.token() != Token::Symbol(')') {
            arguments.push(self.sum()?);
            while self.takes(',') {
                arguments.push(self.sum()?);
            }
        }
        let (wanted, fits) = function.takes(arguments.len());
        if !fits {
            let problem = Problem::Arguments { function: function.name(), wanted, found: arguments.len() };
            return Err(self.error(problem));
        }
        self.expect(')', "\",\" or \")\"")?;
        Ok(Node::Call(function, arguments))
    }

    /// `table(x, [x0, x1, ...], [y0, y1, ...])`
    fn table(&mut self) -> Result<Node, FormulaError> {
        let x = self.sum()?;
        self.expect(',', "\",\" and the knots of the table")?;
        let begin = self.at().start;
        let knots = self.numbers()?;
        self.expect(',', "\",\" and the values of the table")?;
        let values = self.numbers()?;
        let end = self.tokens[self.next - 1].at.end;
        let rises = knots.windows(2).all(|pair| pair[0] < pair[1]);
        if knots.len() < 2 || knots.len() != values.len() || !rises {
            return Err(self.error_at(Problem::Table, begin..end));
        }
        self.expect(')', "\")\"")?;
        Ok(Node::Table(Box::new(x), knots, values))
    }

    /// `[1, -2e3, 0.5]`
    fn numbers(&mut self) -> Result<Vec<f64>, FormulaError> {
        self.expect('[', "\"[\" and numbers")?;
        let mut numbers = Vec::new();
        loop {
            let sign = if self.takes('-') { -1.0 } else { 1.0 };
            let Token::Number(value) = *self.token() else { return Err(self.error(Problem::Expected("a number"))) };
            self.take();
            numbers.push(sign * value);
            if !self.takes(',') {
                break;
            }
        }
        self.expect(']', "\",\" or \"]\"")?;
        Ok(numbers)
    }

    /// `rate(x)` of a name.
    fn rate(&mut self) -> Result<Node, FormulaError> {
        let at = self.at();
        let Token::Name(name) = self.token().clone() else {
            return Err(self.error(Problem::Expected("a name, as in rate(x)")));
        };
        self.take();
        let node = match self.name(&name, at)?.node {
            Node::Name(Symbol::Parameter(number)) => Node::Name(Symbol::State(number)),
            other => other,
        };
        self.expect(')', "\")\" after the name")?;
        Ok(node)
    }

    /// Parses one comparison: returns the side that is larger if it holds, then the other. `expected` is the error text if there
    /// is no comparison.
    fn comparison(&mut self, expected: &'static str) -> Result<[Expression; 2], FormulaError> {
        let left = self.sum()?;
        let is_less = match self.token() {
            Token::Less | Token::LessOrEqual => true,
            Token::Greater | Token::GreaterOrEqual => false,
            _ => return Err(self.error(Problem::Expected(expected))),
        };
        self.take();
        let right = self.sum()?;
        if matches!(self.token(), Token::Less | Token::LessOrEqual | Token::Greater | Token::GreaterOrEqual) {
            return Err(self.error(Problem::ChainedComparison));
        }
        Ok(if is_less { [right, left] } else { [left, right] })
    }

    /// `if(a < b, then, otherwise)`
    fn choice(&mut self) -> Result<Node, FormulaError> {
        let [more, less] = self.comparison("a comparison, as in if(v > 0, a, b)")?;
        self.expect(',', "\",\" and the value where the condition holds")?;
        let then = Box::new(self.sum()?);
        self.expect(',', "\",\" and the value where the condition does not hold")?;
        let otherwise = Box::new(self.sum()?);
        self.expect(')', "\")\"")?;
        Ok(Node::If { less: Box::new(less), more: Box::new(more), then, otherwise })
    }
}

fn binary(operator: Operator, left: Expression, right: Expression) -> Expression {
    let at = left.at.start..right.at.end;
    Expression { node: Node::Binary(operator, Box::new(left), Box::new(right)), at }
}

/// Whether a name can be that of a parameter or a state: a word that is not a variable or function.
pub(super) fn is_word(name: &str) -> bool {
    let mut letters = name.chars();
    letters.next().is_some_and(|first| first.is_ascii_alphabetic() || first == '_')
        && letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}

/// Whether a name is reserved by the language.
pub(super) fn is_reserved(name: &str) -> bool {
    let is_function = FUNCTIONS.iter().any(|(function, _)| *function == name);
    is_function || name == "table" || name == "if" || Symbol::is_variable(name)
}
