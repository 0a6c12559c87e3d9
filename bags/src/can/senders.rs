//! Tells senders of one message apart: the first one stays.

use super::Identifier;

/// Silence after which another sender may take over, ns. Until then the values of the first are still in use.
const SILENCE: i64 = 1_000_000_000;

/// The senders of messages whose source address does not matter.
#[derive(Debug, Clone, Default)]
pub struct Senders {
    messages: Vec<Sender>,
}

#[derive(Debug, Clone, Copy)]
struct Sender {
    /// Identifier of the message in the DBC file.
    message: Identifier,
    /// Identifier of the frames in use, and when the last one came, ns.
    used: Identifier,
    last: i64,
    /// Frames of other senders, and the identifier of the first of them.
    others: u64,
    other: Option<Identifier>,
}

/// Frames of a message that came from more than one sender.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OtherSender {
    /// Source address whose frames are used.
    pub used: u8,
    /// Source address of the first frame that was left out.
    pub other: u8,
    /// Frames that were left out.
    pub frames: u64,
}

impl Senders {
    /// Whether a frame of a message is of the sender in use; `now` in ns on any steady clock. Others are counted.
    pub fn takes(&mut self, message: Identifier, frame: Identifier, now: i64) -> bool {
        let Some(sender) = self.messages.iter_mut().find(|sender| sender.message == message) else {
            self.messages.push(Sender { message, used: frame, last: now, others: 0, other: None });
            return true;
        };
        // One sender may change its priority.
        let is_same = frame.source() == sender.used.source();
        if is_same || now.saturating_sub(sender.last) > SILENCE {
            (sender.used, sender.last) = (frame, sender.last.max(now));
            sender.other = sender.other.filter(|_| is_same);
            return true;
        }
        sender.others += 1;
        sender.other.get_or_insert(frame);
        false
    }

    /// Messages with several senders.
    pub fn others(&self) -> Vec<OtherSender> {
        let of = |sender: &Sender| {
            let (used, other) = (sender.used.source()?, sender.other?.source()?);
            Some(OtherSender { used, other, frames: sender.others })
        };
        self.messages.iter().filter_map(of).collect()
    }

    /// Number of frames that were left out.
    pub fn left_out(&self) -> u64 {
        self.messages.iter().map(|sender| sender.others).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_sender_stays_until_it_is_silent() {
        let at = |source: u32| Identifier { number: 0x18ff_1f00 | source, extended: true };
        let mut senders = Senders::default();
        let message = at(0xe8);
        let mut takes = |source, ms: i64| senders.takes(message, at(source), ms * 1_000_000);
        assert_eq!([takes(0x21, 0), takes(0x42, 5), takes(0x21, 10), takes(0x43, 15)], [true, false, true, false]);
        assert!(takes(0x42, 1011) && !takes(0x21, 1012));
        assert_eq!(senders.left_out(), 3);
        assert_eq!(senders.others(), [OtherSender { used: 0x42, other: 0x21, frames: 3 }]);
    }
}
