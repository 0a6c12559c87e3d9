//! Service replies that are too long for one packet of the network.
//!
//! RustDDS splits a long sample into fragments, and puts one byte too many in front of the inline QoS of each fragment.
//! The library sends inline QoS with every reply. A reply of more than some 1400 bytes (results of actions,
//! descriptions of parameters) is therefore lost, except over the loopback interface with its large packets.
//!
//! Long replies are sent here by a second writer of the same topic, without inline QoS. If the reply must have the
//! identity of the request (`Enhanced` mapping), the whole sample is first sent in one datagram, which IP may fragment.
//! The same sample follows in RTPS fragments, which keeps the sequence numbers of the writer consistent.

use std::sync::{Mutex, PoisonError};

use ros2_client::{Gid, RmwRequestId};
use rosbag2::cdr;
use rustdds::bytes::Bytes;
use rustdds::discovery::DiscoveredReaderData;
use rustdds::no_key::{DataWriter, SimpleDataReader};
use rustdds::{DomainParticipant, RTPSEntity, Timestamp, WriteOptionsBuilder};
use serde::Serialize;

use super::connection::Connection;
use super::qos::SERVICE_DEPTH;
use super::raw_bytes::{RawAdapter, RawBytes};
use super::rtps::{Packet, entity, parameter, sequence_number};
use super::{Mapping, PublishError, TopicQos};

/// Longest reply that is left to the library, bytes. With all headers it fits into the 1452 bytes that RustDDS allows
/// for an Ethernet packet, with 100 to spare.
const SMALL: usize = 1200;
/// Parameter in which rmw_fastrtps_cpp of older distributions expects the identity of the request.
const OLD_RELATED_SAMPLE_IDENTITY: u16 = 0x800f;

/// Sends long replies of one service.
pub struct LargeReplies {
    participant: DomainParticipant,
    topic: String,
    mapping: Mapping,
    writer: DataWriter<RawBytes, RawAdapter>,
    /// Never read. A client of rmw_fastrtps_cpp considers a service ready when its topics have as many readers of
    /// requests as writers of replies.
    _partner: SimpleDataReader<RawBytes, RawAdapter>,
    /// Sequence number of the last sample.
    last: Mutex<i64>,
}

impl LargeReplies {
    /// For the service `name` (full name). Its type in DDS begins with `dds_type`, as in
    /// `rcl_interfaces::srv::dds_::GetParameters`.
    pub fn open(connection: &Connection, mapping: Mapping, name: &str, dds_type: &str) -> Result<Self, String> {
        let qos = TopicQos::reliable(SERVICE_DEPTH).to_dds();
        let participant = connection.participant();
        let failed = |error: rustdds::dds::CreateError| error.to_string();
        let replies = connection.create_topic(&reply_topic(name), &format!("{dds_type}_Response_"), &qos)?;
        let publisher = participant.create_publisher(&qos).map_err(failed)?;
        let writer = publisher.create_datawriter_no_key(&replies, Some(qos.clone())).map_err(failed)?;
        let requests = connection.create_topic(&format!("rq{name}Request"), &format!("{dds_type}_Request_"), &qos)?;
        let subscriber = participant.create_subscriber(&qos).map_err(failed)?;
        let partner = subscriber.create_simple_datareader_no_key(&requests, Some(qos)).map_err(failed)?;
        let last = Mutex::new(0);
        Ok(LargeReplies { participant, topic: reply_topic(name), mapping, writer, _partner: partner, last })
    }

    /// Sends a reply that is too long for the library. Returns `None` for shorter replies, which the library sends.
    pub fn send<A: Serialize>(&self, request: RmwRequestId, answer: &A) -> Option<Result<(), PublishError>> {
        let content = match cdr::encode(answer) {
            Ok(content) => content,
            Err(error) => return Some(Err(PublishError::Failed(error.to_string()))),
        };
        (content.len() > SMALL).then(|| self.send_long(request, content))
    }

    fn send_long(&self, request: RmwRequestId, content: Vec<u8>) -> Result<(), PublishError> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let sample = match self.mapping {
            Mapping::Cyclone => behind_header(request, &content),
            Mapping::Enhanced => {
                self.send_ahead(request, *last + 1, &content)?;
                content
            }
        };
        let options = WriteOptionsBuilder::new().source_timestamp(Timestamp::now()).build();
        let written = self.writer.write_with_options(RawBytes(Bytes::from(sample)), options);
        *last = i64::from(written.map_err(|error| PublishError::Failed(error.to_string()))?.sequence_number);
        Ok(())
    }

    /// Sends the whole sample in one datagram, with the identity of the request.
    fn send_ahead(&self, request: RmwRequestId, sequence: i64, content: &[u8]) -> Result<(), PublishError> {
        let mut related = request.writer_gid.to_bytes16().to_vec();
        related.extend(sequence_number(request.sequence_number));
        let inline = [(parameter::RELATED_SAMPLE_IDENTITY, &related[..]), (OLD_RELATED_SAMPLE_IDENTITY, &related[..])];
        for reader in readers_of(request.writer_gid, &self.topic, &self.participant) {
            let guid = reader.subscription_topic_data.key();
            let packet = Packet::of(self.writer.guid()).to(guid).data(
                entity(guid),
                entity(self.writer.guid()),
                sequence,
                &inline,
                Some(content),
            );
            if !packet.fits() {
                let bytes = content.len();
                return Err(PublishError::Failed(format!("a reply of {bytes} bytes is too long for one datagram")));
            }
            packet.send(reader.reader_proxy.unicast_locator_list);
        }
        Ok(())
    }
}

/// Readers of a DDS topic that belong to the participant of a client.
pub(super) fn readers_of(client: Gid, topic: &str, participant: &DomainParticipant) -> Vec<DiscoveredReaderData> {
    // The first twelve bytes are the GUID prefix of the participant.
    let owner = &client.to_bytes16()[..12];
    let mut readers = participant.discovered_readers();
    readers.retain(|reader| {
        let data = &reader.subscription_topic_data;
        data.topic_name() == topic && data.key().prefix.as_ref() == owner
    });
    readers
}

/// DDS topic for the replies of a service.
pub(super) fn reply_topic(service: &str) -> String {
    format!("rr{service}Reply")
}

/// As rmw_cyclonedds_cpp expects it: the encapsulation is followed by the second half of the client's identity and the
/// sequence number of the request, high part first.
fn behind_header(request: RmwRequestId, content: &[u8]) -> Vec<u8> {
    let (encapsulation, body) = content.split_at(4.min(content.len()));
    let mut sample = encapsulation.to_vec();
    sample.extend(&request.writer_gid.to_bytes16()[8..]);
    sample.extend(sequence_number(request.sequence_number));
    sample.extend(body);
    sample
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_of_cyclone_stands_between_encapsulation_and_content() {
        let mut bytes = [0; 16];
        bytes.iter_mut().zip(1..).for_each(|(byte, number)| *byte = number);
        let request = RmwRequestId { writer_gid: Gid::from(bytes), sequence_number: 7 };
        let sample = behind_header(request, &[0, 1, 0, 0, 42]);
        assert_eq!(sample[..4], [0, 1, 0, 0]);
        assert_eq!(sample[4..12], [9, 10, 11, 12, 13, 14, 15, 16]);
        assert_eq!(sample[12..20], [0, 0, 0, 0, 7, 0, 0, 0]);
        assert_eq!(sample[20..], [42]);
    }
}
