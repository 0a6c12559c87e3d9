//! In place of a CAN bus where the program was built without the feature `can`: none can be opened.

use std::sync::atomic::AtomicBool;

use excavator_ros::Logger;

use super::description::Can;
use super::publisher::{Publisher, Refused};
use super::signals::Treatment;

/// There is none.
pub(super) enum CanSource {}

impl CanSource {
    /// Refuses what is described.
    ///
    /// # Errors
    /// Always: the feature that is needed.
    pub fn open(can: &Can, _: usize, _: &mut [Treatment]) -> Result<Self, String> {
        Err(format!("{}: reading a CAN bus needs a build with the feature `can`", can.dbc.display()))
    }

    /// Whether this source publishes the states itself.
    pub fn is_the_clock(&self) -> bool {
        match *self {}
    }

    /// Reads until told to stop.
    pub fn run(self, _: &Publisher<'_>, _: &Refused, _: &Logger, _: &AtomicBool) {
        match self {}
    }
}
