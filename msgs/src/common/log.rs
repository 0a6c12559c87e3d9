//! `rcl_interfaces/Log`.

use serde::{Deserialize, Serialize};

use crate::{Message, Time};

/// One line of a node's log, as `/rosout` carries it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Log {
    /// When.
    pub stamp: Time,
    /// 10 debug, 20 info, 30 warning, 40 error, 50 fatal.
    pub level: u8,
    /// Name of the logger.
    pub name: String,
    /// What it says.
    pub msg: String,
    /// Source file.
    pub file: String,
    /// Function.
    pub function: String,
    /// Line of the source file.
    pub line: u32,
}

impl Message for Log {
    const TYPE_NAME: &'static str = "rcl_interfaces/msg/Log";
}
