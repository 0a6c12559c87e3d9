//! The monitor's queue of incoming messages, bounded in number and size.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

use excavator_msgs::{ArmState, CylinderState};

/// Most queued states: a minute at 1 kHz.
const WAITING: usize = 60_000;
/// Most queued bytes: a minute at 1 kHz of a machine with four cylinders has 30 MB.
const WAITING_BYTES: usize = 48 << 20;
/// Most cylinders of a state. No machine has so many; a message with more is rejected.
const MOST_CYLINDERS: usize = 32;
/// Longest name of a cylinder, bytes.
const LONGEST_NAME: usize = 128;
/// Longest text of a model, bytes. The largest built-in model has 11 kB.
const LONGEST_MODEL: usize = 1 << 20;

/// A received message.
#[derive(Debug)]
pub(super) enum Incoming {
    State(ArmState),
    Model(String),
}

impl Incoming {
    fn size(&self) -> usize {
        match self {
            Incoming::State(state) => {
                let names: usize = state.cylinders.iter().map(|cylinder| cylinder.name.capacity()).sum();
                size_of::<Incoming>() + names + state.cylinders.capacity() * size_of::<CylinderState>()
            }
            Incoming::Model(text) => size_of::<Incoming>() + text.capacity(),
        }
    }
}

/// Counts of rejected messages.
#[derive(Debug, Default)]
pub(super) struct Counts {
    /// Rejected because the queue was full.
    dropped: AtomicU64,
    /// Rejected because of its size.
    odd: AtomicU64,
}

impl Counts {
    /// The number of states for which there was no room, and of states and models that were too large.
    pub fn get(&self) -> (u64, u64) {
        (self.dropped.load(Ordering::Relaxed), self.odd.load(Ordering::Relaxed))
    }
}

/// The sending end of the queue, for the subscriptions.
#[derive(Debug, Clone)]
pub(super) struct Door {
    sender: SyncSender<Incoming>,
    bytes: Arc<AtomicUsize>,
    counts: Arc<Counts>,
}

/// The receiving end of the queue, for the monitor.
#[derive(Debug)]
pub(super) struct Inbox {
    receiver: Receiver<Incoming>,
    bytes: Arc<AtomicUsize>,
}

/// Both ends of an empty queue.
pub(super) fn inbox() -> (Door, Inbox) {
    let (sender, receiver) = sync_channel(WAITING);
    let bytes = Arc::new(AtomicUsize::new(0));
    (Door { sender, bytes: Arc::clone(&bytes), counts: Arc::default() }, Inbox { receiver, bytes })
}

impl Door {
    /// Queues a state.
    pub fn state(&self, mut state: ArmState) {
        let names_fit = state.cylinders.iter().all(|cylinder| cylinder.name.len() <= LONGEST_NAME);
        if state.cylinders.len() > MOST_CYLINDERS || !names_fit {
            self.counts.odd.fetch_add(1, Ordering::Relaxed);
            return;
        }
        // The field is not used, and can have any length.
        state.header.frame_id = String::new();
        self.put(Incoming::State(state));
    }

    /// Queues a model.
    pub fn model(&self, text: String) {
        if text.len() > LONGEST_MODEL {
            self.counts.odd.fetch_add(1, Ordering::Relaxed);
            return;
        }
        self.put(Incoming::Model(text));
    }

    /// The counts of rejected messages.
    pub fn counts(&self) -> Arc<Counts> {
        Arc::clone(&self.counts)
    }

    fn put(&self, incoming: Incoming) {
        let size = incoming.size();
        // Counted before it is sent, so that the receiver never subtracts bytes that were not added yet.
        let before = self.bytes.fetch_add(size, Ordering::Relaxed);
        if before + size > WAITING_BYTES || self.sender.try_send(incoming).is_err() {
            self.bytes.fetch_sub(size, Ordering::Relaxed);
            self.counts.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl Inbox {
    /// The oldest message. Waits at most `patience`.
    ///
    /// # Errors
    /// No message came in time, or the senders are gone.
    pub fn recv_timeout(&self, patience: Duration) -> Result<Incoming, RecvTimeoutError> {
        let incoming = self.receiver.recv_timeout(patience)?;
        self.bytes.fetch_sub(incoming.size(), Ordering::Relaxed);
        Ok(incoming)
    }
}

#[cfg(test)]
mod tests {
    use excavator_msgs::Header;

    use super::*;

    fn state(cylinders: usize, name: &str) -> ArmState {
        ArmState {
            header: Header::default(),
            cylinders: vec![CylinderState::unmeasured(name); cylinders],
            pump_pressure: 0.0,
            tank_pressure: 0.0,
            pump_flow: 0.0,
            oil_temperature: 0.0,
        }
    }

    #[test]
    fn a_minute_of_an_ordinary_machine_waits() {
        let (door, inbox) = inbox();
        (0..WAITING).for_each(|_| door.state(state(4, "bucket")));
        assert_eq!(door.counts().get(), (0, 0));
        let bytes = inbox.bytes.load(Ordering::Relaxed);
        println!("{:.1} MB wait", bytes as f64 * 1e-6);
        while inbox.recv_timeout(Duration::ZERO).is_ok() {}
        assert_eq!(inbox.bytes.load(Ordering::Relaxed), 0);
    }

    #[test]
    fn what_strangers_send_is_bounded_in_bytes() {
        let (door, inbox) = inbox();
        door.state(state(MOST_CYLINDERS + 1, "arm"));
        door.state(state(1, &"x".repeat(100_000)));
        door.model("x".repeat(LONGEST_MODEL + 1));
        assert_eq!(door.counts().get(), (0, 3));
        (0..20_000).for_each(|_| door.state(state(MOST_CYLINDERS, &"x".repeat(LONGEST_NAME))));
        assert!(inbox.bytes.load(Ordering::Relaxed) <= WAITING_BYTES);
        assert!(door.counts().get().0 > 1000);
    }
}
