//! A question for what a client of Fast DDS asked before we knew it.
//!
//! A client of Fast DDS asks as soon as it has met our reader, which may be before our reader has met its writer. What is
//! said then is dropped here. RustDDS asks again when the writer announces what it has; but its first question has the
//! number 0, which Fast DDS takes for one that it has heard already, and the writer repeats itself three seconds later. This
//! question has the number 1.

use rustdds::{DomainParticipant, GUID};

use super::rtps::{Packet, entity, is_fast_dds};

/// Beginning of the topics of requests.
const REQUESTS: &str = "rq/";

/// Asks a client's writer, which our reader has just been matched with, for its first request.
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
