//! Checks whether the messages of a topic can be decoded.

use std::path::Path;

use excavator_msgs::{Message, definitions, layout};
use rosbag2::{Limit, ReadLimits, Topic};

use crate::BagError;

/// Checks type, serialization and definition of a topic before its first message is decoded.
///
/// A definition with other fields does not always fail to decode: it can also yield wrong numbers.
pub(super) fn check<M: Message>(path: &Path, topic: &Topic) -> Result<(), BagError> {
    let path = || path.to_path_buf();
    let name = || topic.name.clone();
    if !topic.type_name.is_empty() && layout::short_name(&topic.type_name) != layout::short_name(M::TYPE_NAME) {
        let found = topic.type_name.clone();
        return Err(BagError::WrongType { path: path(), topic: name(), found, expected: M::TYPE_NAME });
    }
    if topic.message_encoding != "cdr" {
        let format = topic.message_encoding.clone();
        return Err(rosbag2::Error::UnsupportedSerialization { path: path(), topic: name(), format }.into());
    }
    match difference(M::TYPE_NAME, topic) {
        Some(difference) => {
            Err(BagError::OtherDefinition { path: path(), topic: name(), type_name: M::TYPE_NAME, difference })
        }
        None => Ok(()),
    }
}

/// The first field in which the bag's definition differs from ours; `None` also when the bag has no definition.
fn difference(type_name: &str, topic: &Topic) -> Option<String> {
    if topic.schema_encoding != "ros2msg" || topic.schema.trim().is_empty() {
        return None;
    }
    if let Err(error) = Limit::Definition.check(topic.schema.len() as u64, ReadLimits::DEFAULT.definition) {
        return Some(error.to_string());
    }
    let theirs = layout::flat_fields(type_name, &topic.schema);
    let ours = layout::flat_fields(type_name, &definitions::schema(type_name)?);
    let describe = |field: Option<&layout::Field>| match field {
        Some(field) => format!("\"{} {}\"", field.type_name, field.name),
        None => "nothing".to_string(),
    };
    let longest = ours.len().max(theirs.len());
    (0..longest)
        .find(|&index| ours.get(index) != theirs.get(index))
        .map(|index| format!("it has {} where we have {}", describe(theirs.get(index)), describe(ours.get(index))))
}
