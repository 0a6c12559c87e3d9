//! CAN frames, and the signals in them.

use std::sync::atomic::Ordering;

use excavator_bags::can::{Identifier, Place};
use socketcan::{CanAnyFrame, EmbeddedFrame, Frame as _};

use super::Counts;

/// A data frame.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::arm_bridge) struct Frame {
    pub(super) identifier: Identifier,
    pub(super) data: Vec<u8>,
}

impl Frame {
    /// The data frame; `None` for remote and error frames, which carry no signals.
    pub fn of(frame: &CanAnyFrame) -> Option<Frame> {
        let data = match frame {
            CanAnyFrame::Normal(frame) => frame.data().to_vec(),
            CanAnyFrame::Fd(frame) => frame.data().to_vec(),
            CanAnyFrame::Remote(_) | CanAnyFrame::Error(_) => return None,
        };
        let identifier = Identifier { number: frame.raw_id(), extended: EmbeddedFrame::is_extended(frame) };
        Some(Frame { identifier, data })
    }
}

/// The signals to read from frames.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::arm_bridge) struct Wanted {
    /// Signals in the order of the description.
    pub places: Vec<Place>,
}

impl Wanted {
    /// Passes index and physical value (in the unit of the DBC file) of each wanted signal in the frame to `take`.
    pub fn read(&self, frame: &Frame, counts: &Counts, mut take: impl FnMut(usize, f64)) {
        let mut short = false;
        for (index, place) in self.places.iter().enumerate() {
            if place.identifier() != frame.identifier || !place.is_selected(&frame.data) {
                continue;
            }
            match place.value(&frame.data) {
                Some(value) => take(index, value),
                None => short = true,
            }
        }
        if short {
            counts.short.fetch_add(1, Ordering::Relaxed);
        }
    }
}
