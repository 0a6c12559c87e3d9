//! Signals out of CAN frames: which bits they are says a DBC file, where frames come from a SocketCAN device or a log.

mod bits;
mod database;
mod device;
mod frame;
mod log;
#[cfg(test)]
mod seeded_fuzzing;

pub(super) use database::{Database, Place};
pub(super) use device::Device;
pub(super) use frame::{Counts, Frame, Wanted};
pub(super) use log::Log;
