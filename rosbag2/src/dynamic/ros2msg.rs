//! Parses `ros2msg`: the text of a `.msg` file, followed in bags by the definitions of the contained types.

use std::collections::HashMap;

use super::defined_member::{Count, DefinedMember};
use super::error::LayoutError;
use super::fields::{self, short_name};

/// A run of `=` of at least this length separates definitions; not every writer uses exactly 80.
const SHORTEST_SEPARATOR: usize = 10;

/// The members of every type in a schema; the root is under `type_name`.
pub(super) fn parse(type_name: &str, schema: &str) -> Result<HashMap<String, Vec<DefinedMember>>, LayoutError> {
    let mut types = HashMap::new();
    let mut name = short_name(type_name);
    let mut text = String::new();
    let mut heading_expected = false;
    for line in schema.lines() {
        let content = line.trim();
        if content.len() >= SHORTEST_SEPARATOR && content.bytes().all(|byte| byte == b'=') {
            let finished = members(&text, &name)?;
            types.insert(std::mem::take(&mut name), finished);
            text.clear();
            heading_expected = true;
        } else if heading_expected && !content.is_empty() {
            let heading = content.strip_prefix("MSG:").ok_or_else(|| LayoutError::Syntax {
                near: content.to_string(),
                reason: "a line \"MSG: package/Type\" must follow the separator".to_string(),
            })?;
            name = short_name(heading.trim());
            heading_expected = false;
        } else {
            text.push_str(line);
            text.push('\n');
        }
    }
    let last = members(&text, &name)?;
    types.insert(name, last);
    Ok(types)
}

fn members(text: &str, name: &str) -> Result<Vec<DefinedMember>, LayoutError> {
    let package = fields::package(name);
    fields::fields(text)
        .into_iter()
        .map(|field| {
            let count = count(field.array_suffix())?;
            let base = field.base_type();
            let type_name = if field.is_primitive() {
                base.to_string()
            } else if base == "Header" {
                // Packages from ROS 1 still write it without its package.
                "std_msgs/Header".to_string()
            } else {
                fields::resolve(base, package)
            };
            Ok(DefinedMember { name: field.name, type_name, count })
        })
        .collect()
}

/// `[]` and `[<=5]` are sequences, `[3]` an array.
fn count(suffix: &str) -> Result<Count, LayoutError> {
    if suffix.is_empty() {
        return Ok(Count::One);
    }
    let wrong = || LayoutError::Syntax { near: suffix.to_string(), reason: "expected [], [N] or [<=N]".to_string() };
    let inner = suffix.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).ok_or_else(wrong)?;
    if inner.is_empty() || inner.starts_with("<=") {
        return Ok(Count::Sequence);
    }
    match inner.parse::<usize>() {
        Ok(length) if length > 0 => Ok(Count::Fixed(length)),
        _ => Err(wrong()),
    }
}
