//! Good-bye in words that every peer understands.
//!
//! RustDDS tells its peers that a participant goes by the participant's key as content. Fast DDS wants the hash of the key
//! instead and takes no other word for it, so a node that had ended, or whose link was built anew, stood on its graph
//! until its lease ran out, a minute later.

use std::net::SocketAddr;

use rustdds::{DomainParticipant, GUID, RTPSEntity};

use super::Environment;
use super::rtps::{Packet, everybody, identity, parameter};

/// Entities that announce participants and hear of them, RTPS 9.3.1.5.
const ANNOUNCER: [u8; 4] = [0, 1, 0, 0xc2];
const HEARER: [u8; 4] = [0, 1, 0, 0xc7];
/// A number that no announcement reaches: one a second for many thousand years.
const LAST_WORD: i64 = 1 << 40;
/// Disposed and unregistered.
const GONE: [u8; 4] = [0, 0, 0, 3];

/// Says good-bye for a participant when it is dropped, which must be after the participant has gone: an announcement that
/// comes later would call it back.
pub(super) struct Farewell {
    domain: u16,
    speaker: Option<GUID>,
    addresses: Vec<SocketAddr>,
}

impl Farewell {
    pub fn new(environment: &Environment) -> Self {
        Farewell { domain: environment.domain, speaker: None, addresses: Vec::new() }
    }

    /// Notes who goes, and where the peers are that must hear of it.
    pub fn prepare(&mut self, participant: &DomainParticipant) {
        self.speaker = Some(participant.guid());
        let readers = participant.discovered_readers();
        let writers = participant.discovered_writers();
        let users = readers
            .iter()
            .flat_map(|reader| &reader.reader_proxy.unicast_locator_list)
            .chain(writers.iter().flat_map(|writer| &writer.writer_proxy.unicast_locator_list));
        self.addresses = users.map(|locator| SocketAddr::from(*locator)).filter_map(discovery).collect();
        self.addresses.extend(everybody(self.domain));
        self.addresses.sort_unstable();
        self.addresses.dedup();
    }
}

/// Where the participant with this address for user traffic listens for others: one port below, RTPS 9.6.2.3.
fn discovery(mut user: SocketAddr) -> Option<SocketAddr> {
    user.set_port(user.port().checked_sub(1)?);
    Some(user)
}

impl Drop for Farewell {
    fn drop(&mut self) {
        if let Some(speaker) = self.speaker {
            words(speaker).send(self.addresses.iter().copied());
        }
    }
}

fn words(speaker: GUID) -> Packet {
    let key = identity(speaker);
    let inline: [(u16, &[u8]); 2] = [(parameter::KEY_HASH, &key), (parameter::STATUS_INFO, &GONE)];
    Packet::of(speaker).data(HEARER, ANNOUNCER, LAST_WORD, &inline, None)
}
