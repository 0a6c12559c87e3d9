//! A SocketCAN device.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime};

use excavator_bags::can::{Identifier, Place};
use socketcan::id::{CAN_EFF_FLAG, CAN_SFF_MASK};
use socketcan::{CanFdSocket, CanFilter, ShouldRetry, Socket, SocketOptions};

use super::{Counts, Frame, Wanted};

/// Longest time until the end of the node is noticed, and pause after a failure.
const GLANCE: Duration = Duration::from_millis(100);
/// Longest time that a frame can have waited in the kernel. A stamp that implies more means that the clock was set.
const LONGEST_WAIT: Duration = Duration::from_secs(1);

/// A device that delivers frames. It is reopened after it was unplugged.
#[derive(Debug)]
pub(in crate::arm_bridge) struct Device {
    name: String,
    filters: Vec<CanFilter>,
    socket: CanFdSocket,
}

impl Device {
    /// Opens a device for the frames that are wanted.
    ///
    /// # Errors
    /// What is wrong, in one line.
    pub fn open(name: &str, wanted: &Wanted) -> Result<Self, String> {
        let filters: Vec<CanFilter> = wanted.places.iter().map(filter).collect();
        let socket = open(name, &filters).map_err(|error| format!("CAN device {name}: {error}"))?;
        Ok(Device { name: name.to_string(), filters, socket })
    }

    /// Passes every data frame to `take`, with the time at which the kernel received it, until `stop` is set.
    pub fn listen(mut self, stop: &AtomicBool, counts: &Counts, mut take: impl FnMut(Frame, Instant)) {
        while !stop.load(Ordering::Relaxed) {
            match self.socket.read_frame_with_timestamp() {
                Ok((frame, stamp)) => match Frame::of(&frame) {
                    Some(frame) => take(frame, instant(stamp)),
                    None => {
                        counts.without_data.fetch_add(1, Ordering::Relaxed);
                    }
                },
                Err(error) if error.should_retry() => {}
                // The bus is down or the device is gone. Until it is back its signals become stale, which is reported.
                Err(_) => {
                    std::thread::sleep(GLANCE);
                    if let Ok(socket) = open(&self.name, &self.filters) {
                        self.socket = socket;
                    }
                }
            }
        }
    }
}

fn open(name: &str, filters: &[CanFilter]) -> std::io::Result<CanFdSocket> {
    let socket = CanFdSocket::open(name)?;
    socket.set_filters(filters)?;
    socket.set_recv_timestamp(true)?;
    socket.set_read_timeout(GLANCE)?;
    Ok(socket)
}

/// Accepts the frames that may carry a signal.
fn filter(place: &Place) -> CanFilter {
    match place.identifier() {
        Identifier { number, extended: true } => CanFilter::new(number | CAN_EFF_FLAG, place.mask() | CAN_EFF_FLAG),
        Identifier { number, extended: false } => CanFilter::new(number, CAN_SFF_MASK | CAN_EFF_FLAG),
    }
}

/// The kernel's stamp on the steady clock.
fn instant(stamp: SystemTime) -> Instant {
    let now = Instant::now();
    let waited = SystemTime::now().duration_since(stamp).unwrap_or_default();
    if waited > LONGEST_WAIT { now } else { now.checked_sub(waited).unwrap_or(now) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_that_is_not_there_is_named() {
        let refused = Device::open("nocan9", &Wanted::new(Vec::new()));
        assert!(refused.is_err_and(|reason| reason.starts_with("CAN device nocan9:")));
    }

    #[test]
    fn stamps_of_a_clock_that_was_set_are_not_believed() {
        let now = Instant::now();
        let short = Duration::from_millis(20);
        let recent = instant(SystemTime::now() - short);
        // A busy machine may lie between the readings of the two clocks.
        assert!(recent < now && recent + 20 * short > now);
        assert!(instant(SystemTime::now() - Duration::from_secs(3600)) >= now);
        assert!(instant(SystemTime::now() + Duration::from_secs(3600)) >= now);
    }
}
