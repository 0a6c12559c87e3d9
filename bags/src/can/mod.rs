//! Reads signals from CAN frames. A DBC file defines their bits. The source of the frames does not matter here.

mod bits;
mod database;
mod frame;
mod log;
mod senders;

pub use database::{Database, Identifier, Place};
pub(crate) use frame::{DataFrame, FrameReader};
pub(crate) use log::FrameLog;
pub use log::is_frame_log;
pub use senders::{OtherSender, Senders};
