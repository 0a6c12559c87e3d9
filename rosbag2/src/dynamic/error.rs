//! Errors in definitions and field paths.

use thiserror::Error;

use crate::limits::LimitError;

/// A definition from which the layout of a message cannot be derived.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LayoutError {
    /// A type that neither the bag nor the built-in definitions contain.
    #[error(
        "the type {type_name} is not defined in the bag{}; give its .msg file in the map's `definitions`",
        needed_by(parent)
    )]
    UnknownType {
        /// The type, `package/Type`.
        type_name: String,
        /// The type that contains it; empty for the type of the topic.
        parent: String,
    },
    /// A type that contains itself, or nests deeper than any real one.
    #[error("the type {type_name} nests deeper than {limit} types, perhaps within itself")]
    TooDeep {
        /// The type at which the limit was exceeded.
        type_name: String,
        /// Maximum nesting depth.
        limit: usize,
    },
    /// More fields than any real type has.
    #[error("the type {type_name} contains more than {limit} fields")]
    TooLarge {
        /// The type of the topic.
        type_name: String,
        /// Maximum number of fields.
        limit: usize,
    },
    /// A definition that is larger than any real one.
    #[error(transparent)]
    Limit(#[from] LimitError),
    /// Text that is not a definition.
    #[error("the definition is not understood near \"{near}\": {reason}")]
    Syntax {
        /// The word or line.
        near: String,
        /// What was expected.
        reason: String,
    },
}

fn needed_by(parent: &str) -> String {
    if parent.is_empty() { String::new() } else { format!(" (it is part of {parent})") }
}

/// A field path that names no field, or a field that is not a number.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PathError {
    /// Text that is not a path.
    #[error("\"{path}\" is not a field path: {reason}; write it like position[name=arm] or data[3]")]
    Syntax {
        /// The text.
        path: String,
        /// What is wrong with it.
        reason: String,
    },
    /// No such field.
    #[error("{type_name} has no field \"{wanted}\"; it has {}", existing.join(", "))]
    NoField {
        /// The type that was searched.
        type_name: String,
        /// The name.
        wanted: String,
        /// The fields that the type has.
        existing: Vec<String>,
    },
    /// An array without an index.
    #[error("{field} is an array: say which element, {field}[0] or {field}[name=...]")]
    NeedsIndex {
        /// The field.
        field: String,
    },
    /// An index on a single value.
    #[error("{field} is no array and takes no index")]
    NotAnArray {
        /// The field.
        field: String,
    },
    /// The key of `[key=value]` is not a text field.
    #[error("{field}[{key}=...]: {key} is neither text in the elements of {field} nor a list of texts beside it")]
    NoKey {
        /// The array.
        field: String,
        /// The key.
        key: String,
    },
    /// The path ends at something other than a number.
    #[error("{path} is {found}, not a number")]
    NotANumber {
        /// The path.
        path: String,
        /// What is there: the name of a type, or "text".
        found: String,
    },
    /// The path ends at something other than a time.
    #[error("{path} is not a builtin_interfaces/Time")]
    NotATime {
        /// The path.
        path: String,
    },
}
