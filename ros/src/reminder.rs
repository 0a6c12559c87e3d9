//! Requests samples that a Fast DDS client sent before we knew it.
//!
//! A Fast DDS client sends its request as soon as it has matched our reader. Our reader may not have matched its writer
//! by then, and drops the request. RustDDS asks for the missing sample after the next heartbeat. But its first ACKNACK
//! has the count 0, which Fast DDS ignores as a duplicate; the writer repeats its heartbeat only three seconds later.
//! The ACKNACK sent here has the count 1.

use rustdds::{DomainParticipant, GUID};

use super::rtps::{Packet, entity, is_fast_dds};

/// Prefix of request topics.
const REQUESTS: &str = "rq/";

/// Asks a client's writer, which our reader has just matched, for its first request.
pub(super) fn ask_again(participant: &DomainParticipant, reader: GUID, writer: GUID) {
    if !is_fast_dds(writer) {
        return;
    }
    let writers = participant.discovered_writers();
    let of_client = writers.iter().find(|other| {
        other.writer_proxy.remote_writer_guid == writer && other.publication_topic_data.topic_name.starts_with(REQUESTS)
    });
    let Some(found) = of_client else { return };
    let question = Packet::of(reader).to(writer).ask_for_first(entity(reader), entity(writer));
    question.send(found.writer_proxy.unicast_locator_list.iter().copied());
}
