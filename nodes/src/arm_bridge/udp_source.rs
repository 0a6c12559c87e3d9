//! The thread that receives datagrams.

use std::io::ErrorKind;
use std::net::{IpAddr, UdpSocket};
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
}

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
        Ok(UdpSource { socket, layout, first, sequences })
    }

    /// Receives datagrams until `stop` is set.
    pub fn listen(mut self, signals: &Mutex<Signals>, refused: &Refused, stop: &AtomicBool) {
        // Larger than any datagram, so that a wrong length is detected instead of truncated.
        let mut buffer = vec![0; 65_536];
        while !stop.load(Ordering::Relaxed) {
            let (length, sender) = match self.socket.recv_from(&mut buffer) {
                Ok((length, sender)) => (length, sender.ip().to_canonical()),
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
        sender: IpAddr,
        now: Instant,
        refused: &'r Refused,
    ) -> Result<Vec<f64>, &'r AtomicU64> {
        let senders = &self.layout.senders;
        let place = senders.iter().position(|named| named.to_canonical() == sender);
        if place.is_none() && !senders.is_empty() {
            return Err(&refused.strangers);
        }
        let values = decode(datagram, self.layout).ok_or(&refused.datagrams)?;
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
