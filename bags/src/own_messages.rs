//! The definitions of our own messages, topics that carry them, and messages in bags.

use std::sync::LazyLock;

use excavator_msgs::{Message, definitions};
use rosbag2::dynamic::Definitions;
use rosbag2::{BagWriter, Qos, TopicId, TopicToWrite, cdr};

use crate::BagError;

/// Types of `excavator_msgs`.
const OWN: [&str; 6] = ["ArmState", "CylinderState", "OrificeCommand", "EnergyState", "CylinderEnergy", "EnergyTerm"];

/// The definitions of our own messages, for bags without definitions: SQLite3 bags of ROS 2 Humble and before.
#[must_use]
pub fn own_definitions() -> &'static Definitions {
    static DEFINITIONS: LazyLock<Definitions> = LazyLock::new(|| {
        let mut known = Definitions::default();
        for name in OWN {
            let name = format!("excavator_msgs/{name}");
            if let Some(text) = definitions::message_text(&name) {
                // The texts are built in: a test parses every one.
                let _ = known.add(&name, text);
            }
        }
        known
    });
    &DEFINITIONS
}

/// A topic of one of our own messages, which one publisher offers with `qos`.
#[must_use]
pub fn topic_to_write<M: Message>(name: &str, qos: Qos) -> TopicToWrite {
    TopicToWrite {
        name: name.to_string(),
        type_name: M::TYPE_NAME.to_string(),
        schema: definitions::schema(M::TYPE_NAME).unwrap_or_default(),
        qos: vec![qos],
    }
}

/// Writes one of our own messages, logged and published at `nanoseconds`. `name` is that of the topic, for the error.
///
/// # Errors
/// [`BagError::Unencodable`], and all of [`BagWriter::write`].
pub fn write_message<M: Message>(
    bag: &mut BagWriter,
    topic: TopicId,
    name: &str,
    nanoseconds: u64,
    message: &M,
) -> Result<(), BagError> {
    let bytes = cdr::encode(message)
        .map_err(|error| BagError::Unencodable { topic: name.to_string(), reason: error.to_string() })?;
    Ok(bag.write(topic, nanoseconds, nanoseconds, &bytes)?)
}
