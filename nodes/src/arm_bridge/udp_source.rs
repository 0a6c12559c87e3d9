//! The thread that receives datagrams.

use std::io::ErrorKind;
use std::net::{SocketAddr, UdpSocket};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use super::datagram::{decode, sequence_number};
use super::description::Udp;
use super::publisher::{Refused, lock};
use super::sequence::{Sequence, Verdict};
use super::signals::Signals;
use excavator_ros::RosError;

/// Longest time until the thread notices that the node ends.
const GLANCE: Duration = Duration::from_millis(100);

/// A port that receives datagrams.
pub(super) struct UdpSource<'d> {
    socket: UdpSocket,
    layout: &'d Udp,
    /// Index of its first signal.
    first: usize,
    /// One per named sender, or a single one for all senders on this machine.
    sequences: Vec<Sequence>,
    /// For each named sender, or for all together: its address and port, and when its last datagram came.
    used: Vec<Option<(SocketAddr, Instant)>>,
}

/// Silence after which another program may take over, such as an instrument that starts anew at another port.
const SILENCE: Duration = Duration::from_secs(1);

impl<'d> UdpSource<'d> {
    /// Listens at the described address.
    ///
    /// # Errors
    /// [`RosError::Endpoint`].
    pub fn open(layout: &'d Udp, first: usize) -> Result<Self, RosError> {
        let socket = UdpSocket::bind((layout.address, layout.port))
            .and_then(|socket| socket.set_read_timeout(Some(GLANCE)).map(|()| socket))
            .map_err(|error| RosError::Endpoint {
                what: format!("UDP port {} at {}", layout.port, layout.address),
                reason: error.to_string(),
            })?;
        let sequence = layout.sequence.map(|field| Sequence::new(field.kind));
        let sequences = sequence.map_or(Vec::new(), |sequence| vec![sequence; layout.senders.len().max(1)]);
        let used = vec![None; layout.senders.len().max(1)];
        Ok(UdpSource { socket, layout, first, sequences, used })
    }

    /// Receives datagrams until `stop` is set.
    pub fn listen(mut self, signals: &Mutex<Signals>, refused: &Refused, stop: &AtomicBool) {
        // Larger than any datagram, so that a wrong length is detected instead of truncated.
        let mut buffer = vec![0; 65_536];
        while !stop.load(Ordering::Relaxed) {
            let (length, sender) = match self.socket.recv_from(&mut buffer) {
                Ok((length, sender)) => (length, sender),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => continue,
                Err(_) => {
                    // The network is down and may come back: try again after a pause.
                    std::thread::sleep(GLANCE);
                    continue;
                }
            };
            let now = Instant::now();
            match self.values(&buffer[..length], sender, now, refused) {
                Ok(values) => {
                    let mut signals = lock(signals);
                    for (index, value) in values.into_iter().enumerate() {
                        signals.take(self.first + index, value, now);
                    }
                }
                Err(counter) => {
                    counter.fetch_add(1, Ordering::Relaxed);
                }
            }
        }
    }

    /// The values of a datagram, or the counter for the reason of its rejection.
    fn values<'r>(
        &mut self,
        datagram: &[u8],
        sender: SocketAddr,
        now: Instant,
        refused: &'r Refused,
    ) -> Result<Vec<f64>, &'r AtomicU64> {
        let senders = &self.layout.senders;
        let place = senders.iter().position(|named| named.to_canonical() == sender.ip().to_canonical());
        if place.is_none() && !senders.is_empty() {
            return Err(&refused.strangers);
        }
        let values = decode(datagram, self.layout).ok_or(&refused.datagrams)?;
        if let Some(used) = self.used.get_mut(place.unwrap_or(0)) {
            match used {
                Some((first, last)) if *first != sender && now.saturating_duration_since(*last) < SILENCE => {
                    return Err(&refused.others);
                }
                _ => *used = Some((sender, now)),
            }
        }
        if let (Some(sequence), Some(number)) =
            (self.sequences.get_mut(place.unwrap_or(0)), sequence_number(datagram, self.layout))
        {
            match sequence.take(number, now) {
                Verdict::New { missing } => {
                    refused.missing.fetch_add(missing, Ordering::Relaxed);
                }
                Verdict::Old => return Err(&refused.repeated),
            }
        }
        Ok(values)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::arm_bridge::description::{ByteOrder, LOOPBACK};

    #[test]
    fn the_first_of_two_senders_stays_until_it_is_silent() {
        let layout = Udp {
            port: 0,
            address: LOOPBACK,
            senders: Vec::new(),
            length: 1,
            byte_order: ByteOrder::Little,
            sequence: None,
            fields: Vec::new(),
        };
        let mut source = UdpSource::open(&layout, 0).unwrap();
        let (start, refused) = (Instant::now(), Refused::default());
        let mut takes = |port: u16, ms: u64| {
            let now = start + Duration::from_millis(ms);
            let taken = source.values(&[0], SocketAddr::from((LOOPBACK, port)), now, &refused);
            taken.map_err(|counter| counter.fetch_add(1, Ordering::Relaxed)).is_ok()
        };
        assert_eq!([takes(7, 0), takes(8, 5), takes(7, 10), takes(8, 15)], [true, false, true, false]);
        assert!(takes(8, 1010) && !takes(7, 1015));
        assert_eq!(refused.others.into_inner(), 3);
    }
}
