//! The names of the topics that form a recording.

use std::path::Path;

use excavator_msgs::{ArmState, Message};
use rosbag2::RawMessages;

use crate::BagError;

/// The topic names relative to the namespace of the machine.
const STATE: &str = "arm/state";
const COMMAND: &str = "arm/orifice_command";

/// The topics from which a recording is read, and to which it is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topics {
    /// Topic of `excavator_msgs/msg/ArmState`.
    pub state: String,
    /// Topic of `excavator_msgs/msg/OrificeCommand`.
    pub command: String,
}

impl Default for Topics {
    /// `/arm/state` and `/arm/orifice_command`.
    fn default() -> Self {
        Topics::in_namespace("/")
    }
}

impl Topics {
    /// The topics of a machine whose nodes are in this namespace, with or without a leading slash.
    pub fn in_namespace(namespace: &str) -> Self {
        let parts = namespace.trim_matches('/');
        let full = |name: &str| if parts.is_empty() { format!("/{name}") } else { format!("/{parts}/{name}") };
        Topics { state: full(STATE), command: full(COMMAND) }
    }

    /// The topics of a machine in a bag: of the one in the given namespace; otherwise of the machine without a
    /// namespace, otherwise of the only machine.
    ///
    /// # Errors
    /// All of [`RawMessages::open`]; [`BagError::SeveralMachines`] if a namespace must be given.
    pub fn in_bag(bag: &Path, namespace: Option<&str>) -> Result<Self, BagError> {
        if let Some(namespace) = namespace {
            return Ok(Topics::in_namespace(namespace));
        }
        let topics = RawMessages::open(bag)?.topics();
        let states = topics.iter().filter(|topic| topic.type_name == ArmState::TYPE_NAME);
        let namespaces: Vec<&str> = states.filter_map(|topic| topic.name.strip_suffix(&format!("/{STATE}"))).collect();
        match namespaces[..] {
            [] => Ok(Topics::default()),
            [only] => Ok(Topics::in_namespace(only)),
            _ if namespaces.contains(&"") => Ok(Topics::default()),
            _ => Err(BagError::SeveralMachines {
                path: bag.to_path_buf(),
                namespaces: namespaces.iter().map(|namespace| namespace.to_string()).collect(),
            }),
        }
    }
}
