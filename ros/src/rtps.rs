//! Single messages of the wire protocol (RTPS 2.5) that the middleware has no API for.
//!
//! They are sent in the name of its participant, from a separate socket. Receivers identify the sender by the GUIDs in
//! a message, not by its source port.

use std::net::{SocketAddr, UdpSocket};

use rustdds::GUID;
use socket2::SockRef;

use super::networks::networks;

/// Vendor ID of the participant that the messages are sent for: RustDDS.
const VENDOR: [u8; 2] = [1, 18];
/// Vendor ID of eProsima Fast DDS, the first two bytes of its GUIDs.
const FAST_DDS: [u8; 2] = [1, 15];
/// Largest datagram over IPv4, bytes.
const LARGEST: usize = 65_507;

/// GUID prefix of a participant.
pub(super) type Prefix = [u8; 12];

pub(super) fn prefix_of(bytes: &[u8]) -> Prefix {
    let mut prefix = Prefix::default();
    prefix.iter_mut().zip(bytes).for_each(|(slot, byte)| *slot = *byte);
    prefix
}

/// Kinds of submessages, RTPS 9.4.5.
mod kind {
    pub const ACKNACK: u8 = 0x06;
    pub const INFO_DESTINATION: u8 = 0x0e;
    pub const DATA: u8 = 0x15;
}

/// Flags of submessages, RTPS 9.4.5: little endian; for DATA: inline QoS, payload.
mod flag {
    pub const LITTLE_ENDIAN: u8 = 0x01;
    pub const INLINE_QOS: u8 = 0x02;
    pub const SAMPLE: u8 = 0x04;
}

/// Inline QoS parameters of a DATA submessage, RTPS 9.6.4.
pub(super) mod parameter {
    pub const KEY_HASH: u16 = 0x0070;
    pub const STATUS_INFO: u16 = 0x0071;
    pub const RELATED_SAMPLE_IDENTITY: u16 = 0x0083;
}
const SENTINEL: u16 = 0x0001;

/// The sixteen bytes of a GUID on the wire.
pub(super) fn identity(guid: GUID) -> [u8; 16] {
    ros2_client::Gid::from(guid).to_bytes16()
}

/// Whether a participant, reader or writer belongs to Fast DDS.
pub(super) fn is_fast_dds(guid: GUID) -> bool {
    identity(guid).starts_with(&FAST_DDS)
}

/// A message, built submessage by submessage.
pub(super) struct Packet(Vec<u8>);

impl Packet {
    /// An empty message from the participant of `speaker`.
    pub fn of(speaker: GUID) -> Self {
        let mut bytes = b"RTPS\x02\x04".to_vec();
        bytes.extend(VENDOR);
        bytes.extend(&identity(speaker)[..12]);
        Packet(bytes)
    }

    /// Addresses the following submessages to the participant of `peer` only.
    pub fn to(self, peer: GUID) -> Self {
        self.with(kind::INFO_DESTINATION, flag::LITTLE_ENDIAN, &identity(peer)[..12])
    }

    /// A sample of `writer` for `reader` (entity IDs, the last four bytes of their GUIDs). Without `content`, it
    /// announces that an instance is disposed. `content` begins with its encapsulation.
    pub fn data(
        self,
        reader: [u8; 4],
        writer: [u8; 4],
        sequence: i64,
        inline: &[(u16, &[u8])],
        content: Option<&[u8]>,
    ) -> Self {
        // No extra flags; sixteen bytes from here to the inline QoS.
        let mut body = vec![0, 0, 16, 0];
        body.extend(reader);
        body.extend(writer);
        body.extend(sequence_number(sequence));
        for (name, value) in inline {
            body.extend(name.to_le_bytes());
            body.extend((value.len() as u16).to_le_bytes());
            body.extend(*value);
        }
        body.extend(SENTINEL.to_le_bytes());
        body.extend([0, 0]);
        body.extend(content.unwrap_or_default());
        let sample = if content.is_some() { flag::SAMPLE } else { 0 };
        self.with(kind::DATA, flag::LITTLE_ENDIAN | flag::INLINE_QOS | sample, &body)
    }

    /// An ACKNACK with which `reader` requests the first sample of `writer` and acknowledges none.
    ///
    /// Use it for the first sample only: Fast DDS declares a sample that is requested before it is written irrelevant,
    /// unless nothing was written at all.
    pub fn ask_for_first(self, reader: [u8; 4], writer: [u8; 4]) -> Self {
        let mut body = Vec::new();
        body.extend(reader);
        body.extend(writer);
        body.extend(sequence_number(1));
        // A set with one member: the first bit after the base.
        body.extend(1_u32.to_le_bytes());
        body.extend(0x8000_0000_u32.to_le_bytes());
        // The first count that Fast DDS accepts.
        body.extend(1_i32.to_le_bytes());
        self.with(kind::ACKNACK, flag::LITTLE_ENDIAN, &body)
    }

    fn with(mut self, kind: u8, flags: u8, body: &[u8]) -> Self {
        // If the last submessage is too long for the length field, the field is 0: it extends to the end of the
        // message.
        let length = u16::try_from(body.len()).unwrap_or_default();
        self.0.extend([kind, flags]);
        self.0.extend(length.to_le_bytes());
        self.0.extend(body);
        self
    }

    /// Sends the message to each address. As with every datagram, arrival is not confirmed.
    pub fn send(&self, addresses: impl IntoIterator<Item = impl Into<SocketAddr>>) {
        if !self.fits() {
            return;
        }
        let Ok(socket) = UdpSocket::bind("0.0.0.0:0") else { return };
        let addresses = addresses.into_iter().map(Into::into);
        for address in addresses.filter(|address: &SocketAddr| address.is_ipv4() && address.port() != 0) {
            if address.ip().is_multicast() {
                for (_, network, _) in networks().into_iter().filter(|&(_, _, takes_multicast)| takes_multicast) {
                    let _ = SockRef::from(&socket).set_multicast_if_v4(&network);
                    let _ = socket.send_to(&self.0, address);
                }
            } else {
                let _ = socket.send_to(&self.0, address);
            }
        }
    }

    /// Whether the message fits into one datagram.
    pub fn fits(&self) -> bool {
        self.0.len() <= LARGEST
    }
}

/// High part, low part.
pub(super) fn sequence_number(number: i64) -> [u8; 8] {
    let [high, low] = [(number >> 32) as u32, number as u32];
    let mut bytes = [0; 8];
    bytes[..4].copy_from_slice(&high.to_le_bytes());
    bytes[4..].copy_from_slice(&low.to_le_bytes());
    bytes
}

/// Entity ID: the last four bytes of a GUID.
pub(super) fn entity(guid: GUID) -> [u8; 4] {
    let mut entity = [0; 4];
    entity.copy_from_slice(&identity(guid)[12..]);
    entity
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_laid_out_as_the_standard_says() {
        let packet = Packet::of(GUID::GUID_UNKNOWN).data(
            [1, 2, 3, 4],
            [5, 6, 7, 8],
            0x1_0000_0002,
            &[(0x70, &[9; 4])],
            Some(&[0, 1, 0, 0, 42]),
        );
        let bytes = packet.0;
        assert_eq!(&bytes[..8], b"RTPS\x02\x04\x01\x12");
        assert_eq!(&bytes[8..20], &[0; 12]);
        // header: kind, flags, length of all that follows
        assert_eq!(&bytes[20..24], &[0x15, 0x07, (bytes.len() - 24) as u8, 0]);
        assert_eq!(&bytes[24..28], &[0, 0, 16, 0]);
        // the inline QoS begins sixteen bytes after the offset field
        assert_eq!(&bytes[28..36], &[1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(&bytes[36..44], &[1, 0, 0, 0, 2, 0, 0, 0]);
        assert_eq!(&bytes[44..52], &[0x70, 0, 4, 0, 9, 9, 9, 9]);
        assert_eq!(&bytes[52..56], &[1, 0, 0, 0]);
        assert_eq!(&bytes[56..], &[0, 1, 0, 0, 42]);
    }

    #[test]
    fn a_question_asks_for_number_one_and_acknowledges_nothing() {
        let bytes = Packet::of(GUID::GUID_UNKNOWN).ask_for_first([1; 4], [2; 4]).0;
        // not final: a response is requested
        assert_eq!(bytes[20..24], [0x06, 0x01, 28, 0]);
        assert_eq!(bytes[24..32], [1, 1, 1, 1, 2, 2, 2, 2]);
        assert_eq!(bytes[32..], [0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 128, 1, 0, 0, 0]);
    }

    #[test]
    fn what_is_too_long_for_a_datagram_is_not_sent() {
        let packet = Packet::of(GUID::GUID_UNKNOWN).data([0; 4], [0; 4], 1, &[], Some(&vec![0; 70_000]));
        assert!(!packet.fits());
        packet.send(["127.0.0.1:9".parse::<SocketAddr>().unwrap()]);
    }
}
