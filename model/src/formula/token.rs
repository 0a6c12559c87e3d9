//! Splits text into tokens.

use std::ops::Range;

use super::error::{FormulaError, Problem};

/// The kind of a token.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Number(f64),
    /// A name, with `.` for one of another cylinder: `boom.v`.
    Name(String),
    /// One of `+ - * / ^ ( ) [ ] ,`.
    Symbol(char),
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    End,
}

/// A token and its position.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Placed {
    pub token: Token,
    pub at: Range<usize>,
}

/// Longest formula, bytes. A longer one is a program, not a law.
const LONGEST: usize = 4096;

/// The tokens of a formula, with [`Token::End`] last.
pub(super) fn tokens(text: &str) -> Result<Vec<Placed>, FormulaError> {
    if text.len() > LONGEST {
        return Err(FormulaError::new(Problem::TooLong(LONGEST), 0..0, text));
    }
    let mut found = Vec::new();
    let mut begin = 0;
    while let Some(first) = text[begin..].chars().next() {
        let rest = &text[begin..];
        let (token, length) = match first {
            ' ' | '\t' | '\n' | '\r' => {
                begin += 1;
                continue;
            }
            '0'..='9' | '.' => {
                let length = number_length(rest);
                let value = rest[..length].parse::<f64>().ok().filter(|value| value.is_finite());
                let error = || FormulaError::new(Problem::Number, begin..begin + length.max(1), text);
                (Token::Number(value.ok_or_else(error)?), length)
            }
            'a'..='z' | 'A'..='Z' | '_' => {
                let length = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.'));
                let length = length.unwrap_or(rest.len());
                (Token::Name(rest[..length].to_string()), length)
            }
            '+' | '-' | '*' | '/' | '^' | '(' | ')' | '[' | ']' | ',' => (Token::Symbol(first), 1),
            '<' if rest[1..].starts_with('=') => (Token::LessOrEqual, 2),
            '>' if rest[1..].starts_with('=') => (Token::GreaterOrEqual, 2),
            '<' => (Token::Less, 1),
            '>' => (Token::Greater, 1),
            other => {
                return Err(FormulaError::new(Problem::Character(other), begin..begin + other.len_utf8(), text));
            }
        };
        found.push(Placed { token, at: begin..begin + length });
        begin += length;
    }
    found.push(Placed { token: Token::End, at: text.len()..text.len() });
    Ok(found)
}

/// Length in bytes of the number at the beginning of `text`: digits, a point, digits, an exponent.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut length = digits(0);
    if text[length..].starts_with('.') {
        length += 1;
        length += digits(length);
    }
    if text[length..].starts_with(['e', 'E']) {
        let sign = usize::from(text[length + 1..].starts_with(['+', '-']));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}
