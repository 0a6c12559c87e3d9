//! CAN frames, and the signals in them.

use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use excavator_bags::can::{Identifier, Place, Senders};
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

/// The signals to read from the frames of one bus.
#[derive(Debug)]
pub(in crate::arm_bridge) struct Wanted {
    /// Signals in the order of the description.
    pub places: Vec<Place>,
    senders: Mutex<Senders>,
    /// Moment from which the times of frames count.
    start: Instant,
}

impl Wanted {
    /// These signals, before the first frame.
    pub fn new(places: Vec<Place>) -> Wanted {
        Wanted { places, senders: Mutex::default(), start: Instant::now() }
    }

    /// Passes index and physical value (in the unit of the DBC file) of each wanted signal in a frame that came at `at` to `take`. Of
    /// several senders of one message only the first is used.
    pub fn read(&self, frame: &Frame, at: Instant, counts: &Counts, mut take: impl FnMut(usize, f64)) {
        let Some(message) = self.places.iter().find(|place| place.is_in(frame.identifier)).map(Place::identifier)
        else {
            return;
        };
        let now = i64::try_from(at.saturating_duration_since(self.start).as_nanos()).unwrap_or(i64::MAX);
        let mut senders = self.senders.lock().unwrap_or_else(PoisonError::into_inner);
        if !senders.takes(message, frame.identifier, now) {
            counts.others.fetch_add(1, Ordering::Relaxed);
            return;
        }
        drop(senders);
        let mut short = false;
        for (index, place) in self.places.iter().enumerate() {
            if !place.is_in(frame.identifier) || !place.is_selected(&frame.data) {
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::path::Path;
    use std::time::Duration;

    use excavator_bags::can::Database;

    use super::*;

    #[test]
    fn any_source_is_read_and_a_second_sender_is_counted() {
        let com3 = Database::read(Path::new("com3")).unwrap();
        let wanted = Wanted::new(vec![com3.place("Pressure_1", "boom_cylinder_bottom_pressure").unwrap()]);
        let (start, counts, mut values) = (Instant::now(), Counts::default(), Vec::new());
        for (index, (number, byte)) in
            [(0x18ff_7921, 60), (0x0cff_79e8, 70), (0x18ff_7921, 61), (0x18ff_7a21, 80)].into_iter().enumerate()
        {
            let frame = Frame { identifier: Identifier { number, extended: true }, data: vec![byte; 8] };
            let at = start + Duration::from_millis(index as u64);
            wanted.read(&frame, at, &counts, |_, value| values.push((value * 10.0).round()));
        }
        assert_eq!((values, counts.others.into_inner()), (vec![20.0, 22.0], 1));
    }
}
