//! Reads the lines of one `ros2msg` definition: fields and the types that they refer to.

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_constants_and_defaults_are_no_fields() {
        let text = "# a comment\nint32 LIMIT=3\nint32 OTHER = 4\n\nfloat64 x 1.5 # m\nstring<=10[3] names\n";
        let found = fields(text);
        assert_eq!(
            found.iter().map(|field| format!("{} {}", field.type_name, field.name)).collect::<Vec<_>>(),
            ["float64 x", "string<=10[3] names"]
        );
        assert_eq!(found[1].base_type(), "string");
        assert_eq!(found[1].array_suffix(), "[3]");
    }
}
