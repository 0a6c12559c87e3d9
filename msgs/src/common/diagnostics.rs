//! `diagnostic_msgs/DiagnosticArray` and its parts.

use serde::{Deserialize, Serialize};

use crate::{Header, Message};

/// How the parts of a node are.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticArray {
    /// When.
    pub header: Header,
    /// One entry per part.
    pub status: Vec<DiagnosticStatus>,
}

/// How one part is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticStatus {
    /// 0 OK, 1 warning, 2 error, 3 stale.
    pub level: u8,
    /// Which part.
    pub name: String,
    /// How it is, for people.
    pub message: String,
    /// Which piece of hardware.
    pub hardware_id: String,
    /// Numbers.
    pub values: Vec<KeyValue>,
}

/// One number with its name, both as text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeyValue {
    /// Name, with unit.
    pub key: String,
    /// Value.
    pub value: String,
}

impl Message for DiagnosticArray {
    const TYPE_NAME: &'static str = "diagnostic_msgs/msg/DiagnosticArray";
}

impl Message for DiagnosticStatus {
    const TYPE_NAME: &'static str = "diagnostic_msgs/msg/DiagnosticStatus";
}

impl Message for KeyValue {
    const TYPE_NAME: &'static str = "diagnostic_msgs/msg/KeyValue";
}
