//! The items that most programs need: `use rosbag2::prelude::*;`.
//!
//! [`Error`](crate::Error) is not included, since every crate has one.

pub use crate::dynamic::{Definitions, Layout, Selector, numeric_leaves};
pub use crate::{BagWriter, RawMessage, RawMessages, Topic, TopicToWrite, WriteOptions, info};
