//! Reads order and types of the fields of a message from its `ros2msg` definition.
//!
//! A bag carries the definition that its messages were written with. Its layout is compared with the layout of our
//! definition to decide whether we can decode the messages. Comments and blank lines make no difference.

use std::collections::HashMap;

use crate::definitions;
pub use crate::field::{Field, short_name};
use crate::field::{fields, package, resolve};

/// More fields than any sane message has; stops at a definition that contains itself.
const FIELD_LIMIT: usize = 10_000;
/// More nesting levels than any sane message has.
const DEPTH_LIMIT: usize = 32;

/// All primitive fields of a schema in the order of their bytes. Contained types are replaced by their fields.
///
/// Types that the schema does not define are looked up in [`definitions`]; if unknown there too, the field stays as it
/// is. Comments and spelling (`std_msgs/msg/Header` or `std_msgs/Header`) make no difference.
///
/// ```
/// use excavator_msgs::{definitions, layout};
///
/// let name = "excavator_msgs/msg/OrificeCommand";
/// let schema = definitions::schema(name).ok_or("not known")?;
/// let fields = layout::flat_fields(name, &schema);
/// let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
/// assert_eq!(names, ["header.stamp.sec", "header.stamp.nanosec", "header.frame_id", "names", "areas"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn flat_fields(type_name: &str, schema: &str) -> Vec<Field> {
    let mut sections: HashMap<String, &str> = HashMap::new();
    let mut parts = split_at_separators(schema).into_iter();
    let root = parts.next().unwrap_or_default();
    for part in parts {
        if let Some((heading, text)) = part.trim_start().split_once('\n')
            && let Some(name) = heading.trim().strip_prefix("MSG:")
        {
            sections.insert(short_name(name.trim()), text);
        }
    }
    let mut flat = Flat::default();
    flatten(&sections, root, package(&short_name(type_name)), "", 0, &mut flat);
    flat.fields
}

/// The fields found so far, and how many were visited: types without fields can nest without adding one.
#[derive(Default)]
struct Flat {
    fields: Vec<Field>,
    seen: usize,
}

fn flatten(
    sections: &HashMap<String, &str>,
    text: &str,
    package_name: &str,
    path: &str,
    depth: usize,
    flat: &mut Flat,
) {
    for field in fields(text) {
        if flat.seen >= FIELD_LIMIT {
            return;
        }
        flat.seen += 1;
        let name = format!("{path}{}", field.name);
        let contained = resolve(field.base_type(), package_name);
        let text = sections.get(&contained).copied().or_else(|| definitions::message_text(&contained));
        match text {
            Some(text) if !field.is_primitive() && depth < DEPTH_LIMIT => {
                let path = format!("{name}{}.", field.array_suffix());
                flatten(sections, text, package(&contained), &path, depth + 1, flat);
            }
            _ => flat.fields.push(Field { type_name: field.type_name, name }),
        }
    }
}

/// Parts of a schema between separator lines. Any line of at least ten `=` counts, since not every writer uses exactly
/// 80.
fn split_at_separators(schema: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut start = 0;
    let mut position = 0;
    for line in schema.split_inclusive('\n') {
        let content = line.trim();
        if content.len() >= 10 && content.bytes().all(|byte| byte == b'=') {
            parts.push(&schema[start..position]);
            start = position + line.len();
        }
        position += line.len();
    }
    parts.push(&schema[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(fields: &[Field]) -> Vec<String> {
        fields.iter().map(|field| format!("{} {}", field.type_name, field.name)).collect()
    }

    #[test]
    fn contained_types_are_replaced_by_their_fields() {
        let schema = "a_msgs/B[] many\nstd_msgs/msg/Header header\n====================\nMSG: a_msgs/B\nC c\n\
                      ====================\nMSG: a_msgs/C\nbool yes";
        let flat = flat_fields("a_msgs/msg/A", schema);
        assert_eq!(
            names(&flat),
            ["bool many[].c.yes", "int32 header.stamp.sec", "uint32 header.stamp.nanosec", "string header.frame_id"]
        );
    }

    #[test]
    fn a_definition_that_contains_itself_twice_comes_to_an_end() {
        let schema = "A a\nA b\n====================\nMSG: p/A\nA a\nA b\n";
        assert!(flat_fields("p/A", schema).len() <= FIELD_LIMIT);
        // 31 types that each contain the next type twice; the last type is empty.
        let types = (0..31).map(|n| format!("====================\nMSG: p/T{n}\nT{0} a\nT{0} b\n", n + 1));
        let empty = format!("T0 a\n{}====================\nMSG: p/T31\n", types.collect::<String>());
        assert!(flat_fields("p/A", &empty).is_empty());
    }
}
