//! Questions for what a peer of Fast DDS said before we knew it.
//!
//! A reader of RustDDS asks a writer for what it has missed when the writer announces what it has, and its first question
//! has the number 0, which Fast DDS takes for one that it has heard already. The writer repeats itself three seconds later: so
//! long a participant of Fast DDS had no endpoints for us, and so long the first request of a client waited, if the client
//! had met our reader before our reader had met its writer. These questions have the number 1.

use std::net::SocketAddr;

use rustdds::{DomainParticipant, GUID, RTPSEntity};

use super::rtps::{Packet, entity, everybody, is_fast_dds};

/// Entities that read and write announcements of writers and of readers, RTPS 9.3.1.5.
const ANNOUNCEMENTS: [([u8; 4], [u8; 4]); 2] = [([0, 0, 3, 0xc7], [0, 0, 3, 0xc2]), ([0, 0, 4, 0xc7], [0, 0, 4, 0xc2])];

/// More endpoints than a participant has in a usual node; those that are left come three seconds later.
const ENDPOINTS: u32 = 96;
/// More requests than a client sends before it is met.
const REQUESTS: u32 = 16;

/// Asks a participant that has just been met which endpoints it has.
pub(super) fn ask_for_endpoints(participant: &DomainParticipant, domain: u16, peer: GUID) {
    if !is_fast_dds(peer) {
        return;
    }
    let question = Packet::of(participant.guid()).to(peer);
    let question =
        ANNOUNCEMENTS.iter().fold(question, |q, &(reader, writer)| q.ask_for_first(reader, writer, ENDPOINTS));
    question.send(everybody(domain));
}

/// Asks a writer that our reader has just been matched with for its first samples.
pub(super) fn ask_for_samples(participant: &DomainParticipant, reader: GUID, writer: GUID) {
    if !is_fast_dds(writer) {
        return;
    }
    let writers = participant.discovered_writers();
    let Some(found) = writers.iter().find(|other| other.writer_proxy.remote_writer_guid == writer) else { return };
    let addresses = found.writer_proxy.unicast_locator_list.iter().map(|locator| SocketAddr::from(*locator));
    Packet::of(reader).to(writer).ask_for_first(entity(reader), entity(writer), REQUESTS).send(addresses);
}
