//! Signals out of CAN frames: which bits they are says a DBC file, where frames come from a SocketCAN device or a log.

mod bits;
mod database;
mod device;
mod frame;
pub mod fuzzing;
mod log;

pub(super) use database::{Database, Place};
pub(super) use device::Device;
pub(super) use frame::{Counts, Frame, Wanted};
pub(super) use log::Log;
