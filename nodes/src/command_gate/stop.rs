//! The stop: `/arm/stop`, a heartbeat on it, and the parameter `stop`.
//!
//! This is a software stop, not an emergency stop in the sense of ISO 13850: it depends on this program and on the network.

use std::time::{Duration, Instant};

use super::writer::Writer;

/// Most writers whose stop is stored; more than the panels of any machine.
const MOST_ENGAGED: usize = 32;

#[derive(Debug, Clone, PartialEq, Eq)]
struct Engaged {
    guid: [u8; 16],
    name: String,
}

/// Who has stopped the machine. Any writer may stop it. A stop is released by its own writer; by any writer, once its own
/// writer has left the graph; or at the node, by setting its parameter `stop` to true and back to false.
#[derive(Debug, Clone, Default)]
pub(super) struct Stop {
    engaged: Vec<Engaged>,
    /// More writers have stopped the machine than are stored. Only the node's own parameter releases that.
    overflowed: bool,
    at_the_node: bool,
    heartbeat: Option<Duration>,
    last_message: Option<Instant>,
}

impl Stop {
    /// Requires a message on the stop topic at least once per `interval`; `None`: no heartbeat.
    pub fn require_heartbeat(&mut self, interval: Option<Duration>) {
        self.heartbeat = interval;
    }

    /// Processes a message of the stop topic. `has_left` returns whether a writer has left the graph.
    pub fn take(&mut self, stop: bool, writer: &Writer, has_left: impl Fn(&[u8; 16]) -> bool, now: Instant) {
        self.last_message = Some(now);
        if !stop {
            self.engaged.retain(|engaged| engaged.guid != writer.guid && !has_left(&engaged.guid));
            return;
        }
        if self.engaged.iter().any(|engaged| engaged.guid == writer.guid) {
            return;
        }
        if self.engaged.len() < MOST_ENGAGED {
            self.engaged.push(Engaged { guid: writer.guid, name: writer.name() });
        } else {
            self.overflowed = true;
        }
    }

    /// Applies the node's own parameter. A change back to false releases every stop.
    pub fn set_at_the_node(&mut self, stop: bool) {
        if self.at_the_node && !stop {
            self.engaged.clear();
            self.overflowed = false;
        }
        self.at_the_node = stop;
    }

    /// Who stops the machine at `now`; `None` if it is not stopped.
    pub fn by(&self, now: Instant) -> Option<String> {
        if self.at_the_node {
            return Some("the parameter stop".to_string());
        }
        if let Some(first) = self.engaged.first() {
            return Some(first.name.clone());
        }
        if self.overflowed {
            return Some(format!("more than {MOST_ENGAGED} writers"));
        }
        let heartbeat = self.heartbeat?;
        let is_late = self.last_message.is_none_or(|last| now.saturating_duration_since(last) > heartbeat);
        is_late.then(|| "a missing heartbeat on the stop topic".to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn writer(number: u8) -> Writer {
        Writer { guid: [number; 16], node: Some(format!("/panel{number}")), addresses: Vec::new() }
    }

    fn nobody_left(_: &[u8; 16]) -> bool {
        false
    }

    #[test]
    fn a_stop_is_released_by_the_one_who_gave_it() {
        let now = Instant::now();
        let mut stop = Stop::default();
        assert_eq!(stop.by(now), None);
        stop.take(true, &writer(1), nobody_left, now);
        stop.take(true, &writer(2), nobody_left, now);
        stop.take(false, &writer(1), nobody_left, now);
        stop.take(false, &writer(3), nobody_left, now);
        assert_eq!(stop.by(now).as_deref(), Some("/panel2"));
        stop.take(false, &writer(2), nobody_left, now);
        assert_eq!(stop.by(now), None);
    }

    #[test]
    fn a_stop_of_one_who_has_left_is_released_by_others_but_not_by_itself() {
        let now = Instant::now();
        let mut stop = Stop::default();
        stop.take(true, &writer(1), nobody_left, now);
        assert!(stop.by(now + Duration::from_secs(3600)).is_some());
        stop.take(false, &writer(2), |guid| *guid == [1; 16], now);
        assert_eq!(stop.by(now), None);
    }

    #[test]
    fn the_node_itself_releases_everything() {
        let now = Instant::now();
        let mut stop = Stop::default();
        for number in 0..=255 {
            stop.take(true, &writer(number), nobody_left, now);
        }
        for number in 0..=255 {
            stop.take(false, &writer(number), nobody_left, now);
        }
        assert_eq!(stop.by(now).as_deref(), Some("more than 32 writers"));
        stop.set_at_the_node(true);
        assert_eq!(stop.by(now).as_deref(), Some("the parameter stop"));
        stop.set_at_the_node(false);
        assert_eq!(stop.by(now), None);
    }

    #[test]
    fn a_missing_heartbeat_stops() {
        let start = Instant::now();
        let mut stop = Stop::default();
        stop.require_heartbeat(Some(Duration::from_millis(200)));
        assert!(stop.by(start).is_some());
        stop.take(false, &writer(1), nobody_left, start);
        assert_eq!(stop.by(start + Duration::from_millis(200)), None);
        assert!(stop.by(start + Duration::from_millis(201)).is_some());
    }
}
