//! Reads order and types of the fields of a message from its `ros2msg` definition.
//!
//! A bag carries the definition that its messages were written with. Its layout is compared with the layout of our
//! definition to decide whether we can decode the messages. Comments and blank lines make no difference.

use std::collections::HashMap;

use crate::definitions;

/// More fields than any sane message has; stops at a definition that contains itself.
const FIELD_LIMIT: usize = 10_000;
/// More nesting levels than any sane message has.
const DEPTH_LIMIT: usize = 32;

/// Types that contain no other type.
const PRIMITIVES: [&str; 15] = [
    "bool", "byte", "char", "float32", "float64", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64",
    "uint64", "string", "wstring",
];

/// One field of a message definition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Type as written, with array suffix: `float64[]`, `std_msgs/Header`, `string<=10`.
    pub type_name: String,
    /// Name of the field; dotted with `[]` for array elements after [`flat_fields`]: `cylinders[].name`.
    pub name: String,
}

impl Field {
    /// The type without array suffix and string bound.
    pub fn base_type(&self) -> &str {
        self.type_name.split(['[', '<']).next().unwrap_or_default()
    }

    /// The array suffix, `""` for a single value: `[]`, `[3]`, `[<=5]`.
    pub fn array_suffix(&self) -> &str {
        self.type_name.find('[').map_or("", |at| &self.type_name[at..])
    }

    /// Whether the type contains no other type.
    pub fn is_primitive(&self) -> bool {
        PRIMITIVES.contains(&self.base_type())
    }
}

/// `package/Type` of a name that may also be written `package/msg/Type`.
pub fn short_name(type_name: &str) -> String {
    type_name.replacen("/msg/", "/", 1)
}

/// The package of `package/Type`, `""` when there is none.
pub fn package(short_name: &str) -> &str {
    short_name.split_once('/').map_or("", |(package, _)| package)
}

/// Full short name of the type that a definition of `package` refers to.
pub fn resolve(type_name: &str, package: &str) -> String {
    if type_name.contains('/') { short_name(type_name) } else { format!("{package}/{type_name}") }
}

/// The fields of one definition in order, without comments, blank lines and constants.
pub fn fields(text: &str) -> Vec<Field> {
    let mut fields = Vec::new();
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        let (Some(type_name), Some(name)) = (words.next(), words.next()) else {
            continue;
        };
        let constant = name.contains('=') || words.next().is_some_and(|word| word.starts_with('='));
        if !constant {
            fields.push(Field { type_name: type_name.to_string(), name: name.to_string() });
        }
    }
    fields
}

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
    fn comments_constants_and_defaults_are_no_fields() {
        let text = "# a comment\nint32 LIMIT=3\nint32 OTHER = 4\n\nfloat64 x 1.5 # m\nstring<=10[3] names\n";
        let found = fields(text);
        assert_eq!(names(&found), ["float64 x", "string<=10[3] names"]);
        assert_eq!(found[1].base_type(), "string");
        assert_eq!(found[1].array_suffix(), "[3]");
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
