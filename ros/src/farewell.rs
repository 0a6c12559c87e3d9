//! Announces that a participant has left, in the form that every peer understands.
//!
//! When a participant leaves, RustDDS sends the key of the participant as payload. Fast DDS accepts only the hash of
//! the key. A node that had ended, or whose link was rebuilt, therefore stayed on the graph of Fast DDS until its lease
//! expired a minute later.

use std::net::{Ipv4Addr, SocketAddr};

use rustdds::{DomainParticipant, GUID, RTPSEntity};

use super::rtps::{Packet, identity, is_fast_dds, parameter};
use super::{DiscoveryRange, Environment};

/// Builtin writer and reader of participant announcements, RTPS 9.3.1.5.
const ANNOUNCER: [u8; 4] = [0, 1, 0, 0xc2];
const HEARER: [u8; 4] = [0, 1, 0, 0xc7];
/// A sequence number that announcements never reach: at one per second it takes many thousand years.
const LAST_WORD: i64 = 1 << 40;
/// Disposed and unregistered.
const GONE: [u8; 4] = [0, 0, 0, 3];

/// Announces on drop that a participant has left. Drop it only after the participant: a later announcement would bring
/// the participant back.
pub(super) struct Farewell {
    environment: Environment,
    speaker: Option<GUID>,
    addresses: Vec<SocketAddr>,
}

impl Farewell {
    pub fn new(environment: &Environment) -> Self {
        Farewell { environment: environment.clone(), speaker: None, addresses: Vec::new() }
    }

    /// Stores the participant that leaves and the addresses of the peers to notify.
    pub fn prepare(&mut self, participant: &DomainParticipant) {
        self.speaker = Some(participant.guid());
        let readers = participant.discovered_readers();
        let writers = participant.discovered_writers();
        let reading = readers.iter().map(|r| (r.reader_proxy.remote_reader_guid, &r.reader_proxy.unicast_locator_list));
        let writing = writers.iter().map(|w| (w.writer_proxy.remote_writer_guid, &w.writer_proxy.unicast_locator_list));
        let users = reading.chain(writing).filter(|(guid, _)| is_fast_dds(*guid)).flat_map(|(_, locators)| locators);
        self.addresses = users.map(|locator| SocketAddr::from(*locator)).filter_map(discovery).collect();
        self.addresses.extend(everybody(&self.environment));
        self.addresses.sort_unstable();
        self.addresses.dedup();
    }
}

/// Discovery addresses of the participants of a domain (RTPS 9.6.2.3): the usual ports on this machine, as many as
/// RustDDS tries there, and the multicast address.
fn everybody(environment: &Environment) -> Vec<SocketAddr> {
    let first = 7400 + 250 * environment.domain;
    let here = (0..PARTICIPANTS_HERE).map(|number| SocketAddr::from((Ipv4Addr::LOCALHOST, first + 10 + 2 * number)));
    let subnet = environment.range == DiscoveryRange::Subnet;
    here.chain(subnet.then(|| SocketAddr::from((Ipv4Addr::new(239, 255, 0, 1), first)))).collect()
}
const PARTICIPANTS_HERE: u16 = 12;

/// Discovery address of the participant with this address for user traffic: one port below, RTPS 9.6.2.3.
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn nobody_beyond_this_machine_hears_what_is_for_it_alone() {
        let environment = |range| Environment {
            domain: 3,
            range,
            mapping: crate::Mapping::Enhanced,
            largest_sample: 1 << 20,
            security: crate::Security::Off,
            warnings: Vec::new(),
        };
        let here = everybody(&environment(DiscoveryRange::Localhost));
        assert!(here.iter().all(|address| address.ip().is_loopback()));
        assert_eq!(here.first().map(SocketAddr::port), Some(8160));
        let all = everybody(&environment(DiscoveryRange::Subnet));
        assert_eq!(all.last(), Some(&"239.255.0.1:8150".parse().unwrap()));
        assert_eq!(all.len(), here.len() + 1);
    }

    #[test]
    fn discovery_is_one_port_below_user_traffic() {
        assert_eq!(discovery("10.0.0.1:7411".parse().unwrap()), Some("10.0.0.1:7410".parse().unwrap()));
        assert_eq!(discovery("10.0.0.1:0".parse().unwrap()), None);
    }
}
