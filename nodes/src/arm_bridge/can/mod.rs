//! Where CAN frames come from: a SocketCAN device or a log.

mod device;
mod frame;
pub mod fuzzing;
mod log;

pub(super) use super::frame_counts::Counts;
pub(super) use device::Device;
pub(super) use excavator_bags::can::Database;
pub(super) use frame::{Frame, Wanted};
pub(super) use log::Log;
