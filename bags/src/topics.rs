//! The names of the topics that make a recording.

use std::path::Path;

use excavator_msgs::{ArmState, Message};
use rosbag2::RawMessages;

use crate::BagError;

/// The topics' names in the namespace of their machine.
const STATE: &str = "arm/state";
const COMMAND: &str = "arm/orifice_command";

/// Where the signals of a recording are found in a bag, and where they are written to.
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
    /// Those of a machine whose nodes are in this namespace, with or without its first slash.
    pub fn in_namespace(namespace: &str) -> Self {
        let parts = namespace.trim_matches('/');
        let full = |name: &str| if parts.is_empty() { format!("/{name}") } else { format!("/{parts}/{name}") };
        Topics { state: full(STATE), command: full(COMMAND) }
    }

    /// Those of a machine in a bag: of the one in this namespace; without one, of the machine outside every namespace, else of the only
    /// machine that there is.
    ///
    /// # Errors
    /// All of [`RawMessages::open`]; [`BagError::SeveralMachines`] where a namespace must be given.
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
