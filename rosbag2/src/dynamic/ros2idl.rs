//! Parses `ros2idl`: the subset of OMG IDL in which ROS 2 defines messages, several files separated by lines of `=`.

use std::collections::HashMap;

use super::defined_member::{Count, DefinedMember};
use super::error::LayoutError;

/// A type as written, with typedefs already resolved.
#[derive(Debug, Clone)]
struct Written {
    type_name: String,
    count: Count,
}

/// The members of every struct in a schema.
pub(super) fn parse(schema: &str) -> Result<HashMap<String, Vec<DefinedMember>>, LayoutError> {
    let mut parser = Parser { tokens: tokens(schema), position: 0, ..Parser::default() };
    while parser.position < parser.tokens.len() {
        parser.definition()?;
    }
    Ok(parser.types)
}

/// Words, numbers, texts and single characters; comments, `#include` lines, separators and `IDL:` headings are left
/// out.
fn tokens(schema: &str) -> Vec<String> {
    let text: String = schema
        .lines()
        .filter(|line| {
            let line = line.trim();
            !(line.starts_with('#') || line.starts_with("==========") || line.starts_with("IDL:"))
        })
        .flat_map(|line| [line, "\n"])
        .collect();
    let mut tokens = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest = rest.split_once('\n').map_or("", |(_, after)| after).trim_start();
            continue;
        } else if rest.starts_with("/*") {
            rest = rest.split_once("*/").map_or("", |(_, after)| after).trim_start();
            continue;
        } else if first == '"' || first == '\'' {
            text_length(rest, first)
        } else if first.is_alphanumeric() || first == '_' {
            rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        let (token, after) = rest.split_at(length);
        tokens.push(token.to_string());
        rest = after.trim_start();
    }
    tokens
}

/// Length of a quoted text, quotes included.
fn text_length(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, character) in text.char_indices().skip(1) {
        match character {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if character == quote => return at + 1,
            _ => {}
        }
    }
    text.len()
}

#[derive(Default)]
struct Parser {
    tokens: Vec<String>,
    position: usize,
    modules: Vec<String>,
    typedefs: HashMap<String, Written>,
    types: HashMap<String, Vec<DefinedMember>>,
}

impl Parser {
    fn peek(&self) -> &str {
        self.tokens.get(self.position).map_or("", String::as_str)
    }

    fn next(&mut self) -> String {
        let token = self.peek().to_string();
        self.position += 1;
        token
    }

    fn expect(&mut self, wanted: &str) -> Result<(), LayoutError> {
        let found = self.next();
        if found == wanted { Ok(()) } else { Err(wrong(&found, &format!("expected \"{wanted}\""))) }
    }

    /// Parses a module, struct, enum, constant or typedef, or the end of a module.
    fn definition(&mut self) -> Result<(), LayoutError> {
        self.skip_annotations();
        match self.next().as_str() {
            "module" => {
                let name = self.next();
                self.expect("{")?;
                self.modules.push(name);
            }
            "}" => {
                self.modules.pop();
                self.skip_semicolon();
            }
            "struct" => self.structure()?,
            "typedef" => {
                let written = self.type_name()?;
                let (name, written) = self.declarator(written)?;
                self.typedefs.insert(name, written);
                self.expect(";")?;
            }
            "enum" => {
                let name = self.next();
                self.typedefs.insert(name, Written { type_name: "uint32".to_string(), count: Count::One });
                self.skip_past("}");
                self.skip_semicolon();
            }
            "const" => self.skip_past(";"),
            ";" => {}
            other => return Err(wrong(other, "expected module, struct, enum, typedef or const")),
        }
        Ok(())
    }

    fn structure(&mut self) -> Result<(), LayoutError> {
        let name = self.next();
        self.expect("{")?;
        let mut members = Vec::new();
        loop {
            self.skip_annotations();
            if self.peek() == "}" || self.peek().is_empty() {
                break;
            }
            let written = self.type_name()?;
            let (name, written) = self.declarator(written)?;
            self.expect(";")?;
            // The ROS 2 generator adds a byte of this name to an empty message; it is serialized as well.
            members.push(DefinedMember { name, type_name: written.type_name, count: written.count });
        }
        self.expect("}")?;
        self.skip_semicolon();
        let package = self.modules.first().cloned().unwrap_or_default();
        self.types.insert(format!("{package}/{name}"), members);
        Ok(())
    }

    /// A name followed by its array bounds.
    fn declarator(&mut self, written: Written) -> Result<(String, Written), LayoutError> {
        let name = self.next();
        let mut count = written.count;
        while self.peek() == "[" {
            self.next();
            let length = self.next();
            self.expect("]")?;
            let length = length.parse::<usize>().ok().filter(|&length| length > 0);
            let length = length.ok_or_else(|| wrong(&name, "the length of an array must be a number"))?;
            count = match count {
                Count::One => Count::Fixed(length),
                Count::Fixed(before) => Count::Fixed(before.saturating_mul(length)),
                Count::Sequence => return Err(wrong(&name, "arrays of sequences are not read")),
            };
        }
        Ok((name, Written { type_name: written.type_name, count }))
    }

    fn type_name(&mut self) -> Result<Written, LayoutError> {
        let first = self.next();
        let simple = |name: &str| Ok(Written { type_name: name.to_string(), count: Count::One });
        match first.as_str() {
            "boolean" => simple("bool"),
            "octet" | "uint8" | "char" => simple("uint8"),
            "int8" => simple("int8"),
            "short" | "int16" => simple("int16"),
            "uint16" => simple("uint16"),
            "int32" => simple("int32"),
            "uint32" => simple("uint32"),
            "int64" => simple("int64"),
            "uint64" => simple("uint64"),
            "float" => simple("float32"),
            "double" => simple("float64"),
            "wchar" => simple("wchar"),
            "long" => match self.peek() {
                "long" => {
                    self.next();
                    simple("int64")
                }
                "double" => {
                    self.next();
                    simple("long double")
                }
                _ => simple("int32"),
            },
            "unsigned" => match self.next().as_str() {
                "short" => simple("uint16"),
                "long" if self.peek() == "long" => {
                    self.next();
                    simple("uint64")
                }
                "long" => simple("uint32"),
                other => Err(wrong(other, "expected short or long after unsigned")),
            },
            "string" | "wstring" => {
                if self.peek() == "<" {
                    self.skip_past(">");
                }
                simple(&first)
            }
            "sequence" => {
                self.expect("<")?;
                // Parsed without recursion: nested definitions could overflow the stack.
                if self.peek() == "sequence" {
                    return Err(wrong("sequence", "sequences of sequences are not read"));
                }
                let element = self.type_name()?;
                self.skip_past(">");
                if element.count != Count::One {
                    return Err(wrong("sequence", "sequences of arrays are not read"));
                }
                Ok(Written { type_name: element.type_name, count: Count::Sequence })
            }
            name if name.starts_with(|c: char| c.is_alphabetic() || c == '_') => {
                let mut parts = vec![first.clone()];
                while self.peek() == "::" {
                    self.next();
                    parts.push(self.next());
                }
                self.named(&parts)
            }
            other => Err(wrong(other, "expected a type")),
        }
    }

    /// Resolves a typedef, or a struct of this or another package.
    fn named(&self, parts: &[String]) -> Result<Written, LayoutError> {
        let name = parts.last().cloned().unwrap_or_default();
        if let Some(written) = self.typedefs.get(&name).filter(|_| parts.len() == 1) {
            return Ok(written.clone());
        }
        let package = if parts.len() > 1 { parts.first() } else { self.modules.first() };
        let package = package.cloned().unwrap_or_default();
        Ok(Written { type_name: format!("{package}/{name}"), count: Count::One })
    }

    fn skip_annotations(&mut self) {
        while self.peek() == "@" {
            self.position += 2;
            while self.peek() == "::" {
                self.position += 2;
            }
            if self.peek() == "(" {
                let mut depth = 0;
                while self.position < self.tokens.len() {
                    match self.next().as_str() {
                        "(" => depth += 1,
                        ")" => depth -= 1,
                        _ => {}
                    }
                    if depth == 0 {
                        break;
                    }
                }
            }
        }
    }

    fn skip_past(&mut self, end: &str) {
        while self.position < self.tokens.len() && self.next() != end {}
    }

    fn skip_semicolon(&mut self) {
        if self.peek() == ";" {
            self.position += 1;
        }
    }
}

fn wrong(near: &str, reason: &str) -> LayoutError {
    LayoutError::Syntax { near: near.to_string(), reason: reason.to_string() }
}
