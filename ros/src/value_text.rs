//! Parameter values written as YAML.

use rosbag2::ReadLimits;
use rosbag2::yaml::{self, Yaml};

use super::Value;

/// The value of a YAML scalar or of a YAML list of scalars of one type; `None` for anything else.
pub(super) fn from_yaml(yaml: &Yaml) -> Option<Value> {
    match yaml {
        Yaml::Bool(value) => Some(Value::Boolean(*value)),
        Yaml::Integer(value) => Some(Value::Integer(*value)),
        Yaml::Double(value) => Some(Value::Double(*value)),
        Yaml::String(text) => Some(Value::String(text.clone())),
        Yaml::Sequence(items) => from_list(&items.iter().map(from_yaml).collect::<Option<Vec<Value>>>()?),
        Yaml::Null | Yaml::Mapping(_) => None,
    }
}

/// The value of the text after `name:=`.
pub(super) fn from_text(text: &str) -> Option<Value> {
    let yaml: Yaml = yaml::from_str(text, &ReadLimits::DEFAULT).ok()?;
    // If YAML reads null or a map, text was meant: `-p model:=`, `-p model:=a: b`.
    from_yaml(&yaml).or_else(|| (!matches!(yaml, Yaml::Sequence(_))).then(|| Value::String(text.to_string())))
}

fn from_list(items: &[Value]) -> Option<Value> {
    let all = |same: fn(&Value) -> bool| items.iter().all(same);
    if all(|value| matches!(value, Value::Boolean(_))) && !items.is_empty() {
        return Some(Value::BooleanArray(items.iter().filter_map(Value::as_bool).collect()));
    }
    if all(|value| matches!(value, Value::Integer(_))) && !items.is_empty() {
        return Some(Value::IntegerArray(items.iter().filter_map(Value::as_integer).collect()));
    }
    if all(|value| matches!(value, Value::Integer(_) | Value::Double(_))) && !items.is_empty() {
        return Some(Value::DoubleArray(items.iter().filter_map(Value::as_double).collect()));
    }
    // An empty list has no type; it fits every array parameter through `Value::fitted_to`.
    all(|value| matches!(value, Value::String(_)))
        .then(|| Value::StringArray(items.iter().filter_map(|value| value.as_text().map(str::to_string)).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_have_the_types_that_ros_gives_them() {
        let cases = [
            ("3", Value::Integer(3)),
            ("3.0", Value::Double(3.0)),
            ("1e3", Value::Double(1e3)),
            ("true", Value::Boolean(true)),
            ("zx30u", Value::String("zx30u".into())),
            ("'3'", Value::String("3".into())),
            ("[1, 2]", Value::IntegerArray(vec![1, 2])),
            ("[1, 2.5]", Value::DoubleArray(vec![1.0, 2.5])),
            ("[a, b]", Value::StringArray(vec!["a".into(), "b".into()])),
            ("", Value::String(String::new())),
        ];
        for (text, expected) in cases {
            assert_eq!(from_text(text), Some(expected), "{text}");
        }
    }

    #[test]
    fn lists_of_mixed_types_have_no_value() {
        for text in ["[1, a]", "[true, 2]", "[[1], [2]]", "[1"] {
            assert_eq!(from_text(text), None, "{text}");
        }
    }
}
