//! The messages of a bag, or of a log of CAN frames.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rosbag2::{Damage, RawMessage, RawMessages, ReadLimits, Topic};

use crate::can::{FrameLog, is_frame_log};

/// Where messages come from.
pub(super) enum Messages {
    Bag(Box<RawMessages>),
    Log(PathBuf, FrameLog),
}

impl Messages {
    /// Opens the bag, or the log of `candump`, at `path`.
    ///
    /// # Errors
    /// Those of [`RawMessages::open`].
    pub fn open(path: &Path) -> Result<Messages, rosbag2::Error> {
        if is_frame_log(path) {
            return Ok(Messages::Log(path.to_path_buf(), FrameLog::open(path)?));
        }
        Ok(Messages::Bag(Box::new(RawMessages::open(path)?)))
    }

    pub fn path(&self) -> &Path {
        match self {
            Messages::Bag(bag) => bag.path(),
            Messages::Log(path, _) => path,
        }
    }

    /// The topics so far; complete after the last message.
    pub fn topics(&self) -> Vec<Arc<Topic>> {
        match self {
            Messages::Bag(bag) => bag.topics(),
            Messages::Log(_, log) => log.topics(),
        }
    }

    pub fn damage(&self) -> Vec<Damage> {
        match self {
            Messages::Bag(bag) => bag.damage(),
            Messages::Log(..) => Vec::new(),
        }
    }

    pub fn promised_messages(&self) -> Option<u64> {
        match self {
            Messages::Bag(bag) => bag.promised_messages(),
            Messages::Log(..) => None,
        }
    }

    /// Lines of a log that are no records.
    pub fn unreadable(&self) -> u64 {
        match self {
            Messages::Bag(_) => 0,
            Messages::Log(_, log) => log.unreadable,
        }
    }

    /// Checks the memory for what is read, bytes, as [`RawMessages::check_memory`] does.
    ///
    /// # Errors
    /// [`rosbag2::Error::Limit`].
    pub fn check_memory(&self, needed: u64) -> Result<(), rosbag2::Error> {
        match self {
            Messages::Bag(bag) => bag.check_memory(needed),
            Messages::Log(path, log) => {
                let limit = |source| rosbag2::Error::Limit { path: path.clone(), source };
                ReadLimits::DEFAULT.check_memory(needed, log.bytes).map_err(limit)
            }
        }
    }
}

impl Iterator for Messages {
    type Item = Result<RawMessage, rosbag2::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        match self {
            Messages::Bag(bag) => bag.next(),
            Messages::Log(_, log) => log.next(),
        }
    }
}
