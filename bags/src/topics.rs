//! The names of the topics that make a recording.

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
        Topics { state: "/arm/state".to_string(), command: "/arm/orifice_command".to_string() }
    }
}
