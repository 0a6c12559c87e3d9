//! Reads signals from CAN frames. A DBC file defines their bits. The source of the frames does not matter here.

mod bits;
mod database;
mod frame;

pub use database::{Database, Identifier, Place};
pub(crate) use frame::{DataFrame, FrameReader};
