//! Signals out of CAN frames: which bits they are says a DBC file. Where frames come from does not matter here.

mod bits;
mod database;
mod frame;

pub use database::{Database, Identifier, Place};
pub(crate) use frame::{DataFrame, FrameReader};
