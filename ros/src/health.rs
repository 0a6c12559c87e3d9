//! Detects permanent faults of the middleware.
//!
//! Three faults of the middleware end communication silently. A fourth lets its memory grow without bound
//! ([`super::memory`]).
//!
//! A peer whose lease expired is never matched again, since its announcements look like duplicates. The threads of the
//! middleware end when a system call is interrupted (SIGSTOP and SIGCONT, a frozen container, suspend to disk). A peer
//! that uses Fast DDS may permanently miss some of our endpoints ([`super::probe`]).
//!
//! The remedy for all of them is a new participant. Creating one disturbs every other peer, so it needs proof: a dead
//! thread, a lost peer that is back and communicated with this node, or a peer that answers new endpoints but not old
//! ones. Our own participant cannot see that a lost peer is back. A second participant without endpoints, the scout,
//! detects this.

use std::collections::BTreeSet;
use std::net::Ipv4Addr;

use rustdds::{DomainParticipant, DomainParticipantStatusEvent, LostReason, RTPSEntity, StatusEvented};

use super::Environment;
use super::connection::participant;
use super::dds_names::dds_topic;
use super::memory::Memory;
use super::networks::networks;
use super::patience::{BUILDING, let_go, within};
use super::probe::{Probe, Probes};
use super::reminder::ask_again;
use super::rtps::{Prefix, prefix_of};
use super::threads::{Died, Threads};

/// Why the link must be rebuilt.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Fault {
    /// Threads of the middleware have ended.
    ThreadsDied(Died),
    /// A lost peer is back, but our participant cannot reach it.
    PeerReturned(Prefix),
    /// A peer does not know our first endpoints.
    HalfKnown,
    /// The memory of the process has grown too much, MB.
    MemoryGrown { before: u64, now: u64 },
    /// Our participant does not use a new network, and there is no other peer that a rebuild would disturb.
    NewNetwork(String),
}

impl std::fmt::Display for Fault {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Fault::ThreadsDied(Died { alive, started }) => {
                write!(formatter, "{} of {started} threads of the middleware have ended", started - alive)
            }
            Fault::PeerReturned(prefix) => {
                let name: String = prefix.iter().map(|byte| format!("{byte:02x}")).collect();
                write!(formatter, "peer {name} was lost and is back")
            }
            Fault::HalfKnown => write!(formatter, "a peer has missed a part of our endpoints"),
            Fault::MemoryGrown { before, now } => write!(formatter, "memory has grown from {before} to {now} MB"),
            Fault::NewNetwork(name) => write!(formatter, "network {name} is new"),
        }
    }
}

/// What the watch has observed since the last call.
#[derive(Debug, Default)]
pub(super) struct Observations {
    pub fault: Option<Fault>,
    /// Lines for the log.
    pub notes: Vec<String>,
}

/// Watches one connection.
pub(super) struct Watch {
    environment: Environment,
    participant: DomainParticipant,
    threads: Threads,
    present: BTreeSet<Prefix>,
    /// Peers that have read or written our topics or services. Others, such as the daemon of the command line, may come
    /// and go.
    partners: BTreeSet<Prefix>,
    lost: BTreeSet<Prefix>,
    scout: Option<Scout>,
    networks: BTreeSet<(String, Ipv4Addr)>,
    memory: Option<Memory>,
    probes: Option<Probes>,
}

impl Watch {
    /// Watches a newly built connection and, with `memory`, that of this process.
    pub fn new(
        environment: Environment,
        participant: DomainParticipant,
        threads: Threads,
        probe: Option<Probe>,
        memory: Option<Memory>,
    ) -> Self {
        Watch {
            probes: probe.map(Probes::new),
            environment,
            participant,
            threads,
            present: BTreeSet::new(),
            partners: BTreeSet::new(),
            lost: BTreeSet::new(),
            scout: None,
            networks: addresses(),
            memory,
        }
    }

    /// Number of peers that are present.
    pub fn peers(&self) -> usize {
        self.present.len()
    }

    /// Number of lost peers that may come back.
    pub fn lost(&self) -> usize {
        self.lost.len()
    }

    /// Checks the connection. `ours` has the topics and services of this node.
    pub fn look(&mut self, ours: &Ours) -> Observations {
        let died = self.threads.died().map(Fault::ThreadsDied);
        let grown = self.memory.as_mut().and_then(Memory::grown);
        let grown = grown.map(|(before, now)| Fault::MemoryGrown { before, now });
        let mut seen = Observations { fault: died.or(grown), notes: Vec::new() };
        if seen.fault.is_some() {
            return seen;
        }
        self.note_partners(ours);
        let mut newly_lost = false;
        // Our own announcements are also received here. They stop when the network is down.
        let own = prefix_of(self.participant.guid().prefix.as_ref());
        let listener = self.participant.status_listener();
        while let Some(event) = listener.try_recv_status() {
            match event {
                DomainParticipantStatusEvent::ParticipantDiscovered { dpd } => {
                    let prefix = prefix_of(dpd.guid.prefix.as_ref());
                    if prefix == own {
                        continue;
                    }
                    if self.lost.contains(&prefix) {
                        seen.fault = Some(Fault::PeerReturned(prefix));
                    }
                    self.present.insert(prefix);
                }
                DomainParticipantStatusEvent::ParticipantLost { id, reason } => {
                    let prefix = prefix_of(id.as_ref());
                    if prefix == own {
                        continue;
                    }
                    self.present.remove(&prefix);
                    match reason {
                        LostReason::Disposed => {
                            self.lost.remove(&prefix);
                            self.partners.remove(&prefix);
                        }
                        LostReason::Timeout { .. } if !self.partners.contains(&prefix) => {}
                        LostReason::Timeout { .. } => {
                            newly_lost |= self.lost.insert(prefix);
                            seen.notes.push(format!("peer {id:?} is out of reach"));
                        }
                    }
                }
                DomainParticipantStatusEvent::RemoteWriterMatched { local_reader, remote_writer } => {
                    ask_again(&self.participant, local_reader, remote_writer);
                }
                DomainParticipantStatusEvent::RemoteReaderQosIncompatible { remote_reader, .. } => {
                    seen.notes
                        .push(format!("reader {remote_reader:?} asks for a quality of service that we do not offer"));
                }
                DomainParticipantStatusEvent::RemoteWriterQosIncompatible { remote_writer, .. } => {
                    seen.notes
                        .push(format!("writer {remote_writer:?} does not offer the quality of service that we ask"));
                }
                _ => {}
            }
        }
        self.send_scout(newly_lost, &mut seen);
        let half_known = self.probes.as_mut().is_some_and(|probes| probes.look(&self.participant, &self.present));
        if seen.fault.is_none() && half_known {
            seen.fault = Some(Fault::HalfKnown);
        }
        if seen.fault.is_none() && self.present.is_empty() {
            let new = addresses().into_iter().find(|network| !self.networks.contains(network));
            seen.fault = new.map(|(name, address)| Fault::NewNetwork(format!("{name} ({address})")));
        }
        seen
    }

    /// Adds the peers with a discovered endpoint that matches one of ours.
    fn note_partners(&mut self, ours: &Ours) {
        if self.present.is_subset(&self.partners) {
            return;
        }
        let readers = self.participant.discovered_readers();
        let reading = readers.iter().map(|reader| {
            let data = &reader.subscription_topic_data;
            (reader.reader_proxy.remote_reader_guid, ours.is_read_by(data.topic_name()))
        });
        let writers = self.participant.discovered_writers();
        let writing = writers.iter().map(|writer| {
            let data = &writer.publication_topic_data;
            (writer.writer_proxy.remote_writer_guid, ours.is_written_by(&data.topic_name))
        });
        let with_us = reading.chain(writing).filter(|(_, has_to_do)| *has_to_do);
        self.partners.extend(with_us.map(|(guid, _)| prefix_of(guid.prefix.as_ref())));
    }

    fn send_scout(&mut self, newly_lost: bool, seen: &mut Observations) {
        let blind = self.scout.as_mut().is_some_and(|scout| scout.threads.died().is_some());
        // A scout that has already met the lost peer would miss its return, just as our participant does.
        if self.lost.is_empty() || newly_lost || blind {
            self.dismiss_scout();
        }
        if self.lost.is_empty() {
            return;
        }
        if self.scout.is_none() {
            match Scout::send(self.environment.clone()) {
                Ok(scout) => self.scout = Some(scout),
                Err(reason) => seen.notes.push(format!("cannot look out for lost peers: {reason}")),
            }
        }
        let Some(scout) = &self.scout else { return };
        let listener = scout.participant.status_listener();
        while let Some(event) = listener.try_recv_status() {
            if let DomainParticipantStatusEvent::ParticipantDiscovered { dpd } = event {
                let prefix = prefix_of(dpd.guid.prefix.as_ref());
                if self.lost.contains(&prefix) {
                    seen.fault = Some(Fault::PeerReturned(prefix));
                }
            }
        }
    }

    fn dismiss_scout(&mut self) {
        if let Some(scout) = self.scout.take() {
            let_go(scout);
        }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.dismiss_scout();
        if let Some(probes) = self.probes.take() {
            let_go(probes);
        }
    }
}

/// Topics and services of a node, with their DDS names.
#[derive(Debug, Clone, Default)]
pub(super) struct Ours {
    /// Topics.
    topics: BTreeSet<String>,
    /// Prefix of the topics of our own services, after `rq` or `rr`.
    services: String,
}

impl Ours {
    /// For the node with this full name and these topics.
    pub fn new(node: &str, topics: impl IntoIterator<Item = String>) -> Self {
        Ours { topics: topics.into_iter().map(|topic| dds_topic(&topic)).collect(), services: format!("{node}/") }
    }

    fn is_read_by(&self, topic: &str) -> bool {
        self.topics.contains(topic) || self.is_service(topic)
    }

    /// Every node writes to the shared topics of log and parameter events. This does not make it a partner.
    fn is_written_by(&self, topic: &str) -> bool {
        !matches!(topic, "rt/rosout" | "rt/parameter_events") && self.is_read_by(topic)
    }

    fn is_service(&self, topic: &str) -> bool {
        ["rq", "rr"].iter().any(|kind| topic.strip_prefix(kind).is_some_and(|name| name.starts_with(&self.services)))
    }
}

/// A participant without endpoints.
struct Scout {
    participant: DomainParticipant,
    threads: Threads,
}

impl Scout {
    fn send(environment: Environment) -> Result<Self, String> {
        let built = within(BUILDING, move || Threads::started_by(|| participant(&environment)));
        let (participant, threads) = built.ok_or("the middleware does not answer")?;
        let (participant, _) = participant?;
        Ok(Scout { participant, threads })
    }
}

/// Names and addresses of the networks that are up.
fn addresses() -> BTreeSet<(String, Ipv4Addr)> {
    networks().into_iter().map(|(name, address, _)| (name, address)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peer_has_to_do_with_us_by_what_it_reads_and_writes() {
        let ours = Ours::new("/pit/simulator", ["/pit/arm/state".to_string(), "/rosout".to_string()]);
        assert!(ours.is_read_by("rt/pit/arm/state") && ours.is_written_by("rt/pit/arm/state"));
        assert!(ours.is_read_by("rt/rosout") && !ours.is_written_by("rt/rosout"));
        assert!(ours.is_read_by("rr/pit/simulator/get_parametersReply"));
        assert!(ours.is_written_by("rq/pit/simulator/get_parametersRequest"));
        assert!(!ours.is_read_by("rq/_ros2cli_daemon/get_parametersRequest") && !ours.is_read_by("ros_discovery_info"));
    }

    #[test]
    fn a_fault_says_what_happened() {
        let died = Fault::ThreadsDied(Died { alive: 1, started: 2 });
        assert_eq!(died.to_string(), "1 of 2 threads of the middleware have ended");
        assert_eq!(Fault::MemoryGrown { before: 30, now: 140 }.to_string(), "memory has grown from 30 to 140 MB");
    }
}
