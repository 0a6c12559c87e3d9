//! Replaces the CAN source in builds without the feature `can`: no CAN bus can be opened.

use std::sync::atomic::AtomicBool;

use excavator_ros::Logger;

use super::description::Can;
use super::publisher::{Publisher, Refused};
use super::signals::Treatment;

/// No value of this type exists.
pub(super) enum CanSource {}

impl CanSource {
    /// Always fails.
    ///
    /// # Errors
    /// Always: names the feature that is needed.
    pub fn open(can: &Can, _: usize, _: &mut [Treatment]) -> Result<Self, String> {
        Err(format!("{}: reading a CAN bus needs a build with the feature `can`", can.dbc.display()))
    }

    /// Whether this source publishes the states itself.
    pub fn is_the_clock(&self) -> bool {
        match *self {}
    }

    /// Reads until `stop` is set.
    pub fn run(self, _: &Publisher<'_>, _: &Refused, _: &Logger, _: &AtomicBool) {
        match self {}
    }
}
