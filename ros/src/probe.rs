//! Detects that a peer does not know all of our endpoints.
//!
//! RustDDS announces its endpoints without a source timestamp. Fast DDS orders announcements by that timestamp, or by
//! arrival if there is none. An announcement made while the two participants meet can overtake earlier ones. Fast DDS
//! then discards these: it acknowledges them, but never requests them again and never matches them.
//!
//! Every ROS 2 participant reads and writes one topic to announce its nodes. A probe is a writer and a reader on that
//! topic. The first probe is created before all other endpoints of a connection, so it is among the discarded ones. If
//! it is not acknowledged, or receives nothing from a peer, a second probe is opened. A peer that answers the second
//! probe but not the first does not know the first. A peer that is stopped or starved of CPU time answers neither.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use ros2_client::Gid;
use ros2_client::builtin_topics::ros_discovery;
use ros2_client::entities_info::ParticipantEntitiesInfo;
use rosbag2::cdr;
use rustdds::bytes::Bytes;
use rustdds::no_key::{DataWriter, SimpleDataReader};
use rustdds::{DomainParticipant, RTPSEntity, Timestamp, TopicKind};

use super::TopicQos;
use super::patience::{BUILDING, let_go, within};
use super::raw_bytes::{RawAdapter, RawBytes};
use super::rtps::{Prefix, prefix_of};

/// Time for a peer to answer before it is suspected: ten times what it takes beside four busy loops.
const ANSWER: Duration = Duration::from_secs(3);
/// Time by which the second probe must be ahead of the first. A peer that has woken up answers both within
/// milliseconds.
const AHEAD: Duration = Duration::from_secs(1);

/// A writer and a reader on the topic where participants announce their nodes.
pub(super) struct Probe {
    writer: DataWriter<RawBytes, RawAdapter>,
    reader: SimpleDataReader<RawBytes, RawAdapter>,
    heard: BTreeSet<Prefix>,
}

impl Probe {
    /// Opens both endpoints.
    ///
    /// # Errors
    /// The error message of the middleware.
    pub fn open(participant: &DomainParticipant) -> Result<Self, String> {
        let qos = TopicQos::latched().to_dds();
        let (name, type_name) = (ros_discovery::TOPIC_NAME.to_string(), ros_discovery::TYPE_NAME.to_string());
        let failed = |error: rustdds::dds::CreateError| error.to_string();
        let topic = participant.create_topic(name, type_name, &qos, TopicKind::NoKey).map_err(failed)?;
        let publisher = participant.create_publisher(&qos).map_err(failed)?;
        let writer = publisher.create_datawriter_no_key(&topic, Some(qos.clone())).map_err(failed)?;
        let subscriber = participant.create_subscriber(&qos).map_err(failed)?;
        let reader = subscriber.create_simple_datareader_no_key(&topic, Some(qos)).map_err(failed)?;
        let probe = Probe { writer, reader, heard: BTreeSet::new() };
        probe.speak()?;
        Ok(probe)
    }

    /// The same on a connection in use, or `None` if it fails or does not return in time: a writer that is created while
    /// the threads of the middleware end deadlocks (see `patience.rs`).
    fn open_in_time(participant: &DomainParticipant) -> Option<Self> {
        let participant = participant.clone();
        within(BUILDING, move || Probe::open(&participant))?.ok()
    }

    /// Announces a participant without nodes, identified by the GUID of this writer. Other listeners are not affected.
    fn speak(&self) -> Result<(), String> {
        let nobody = ParticipantEntitiesInfo::new(Gid::from(self.writer.guid()), Vec::new());
        let bytes = cdr::encode(&nobody).map_err(|error| error.to_string())?;
        let written = self.writer.write(RawBytes(Bytes::from(bytes)), Some(Timestamp::now()));
        written.map_err(|error| error.to_string())
    }

    /// Whether all readers have acknowledged.
    fn is_acknowledged(&self) -> bool {
        self.writer.wait_for_acknowledgments(Duration::ZERO).unwrap_or(true)
    }

    /// Takes all received samples.
    fn listen(&mut self) {
        while let Ok(Some(sample)) = self.reader.try_take_one() {
            self.heard.insert(prefix_of(sample.writer_guid().prefix.as_ref()));
        }
    }

    fn answers(&mut self) -> Answers {
        self.listen();
        Answers { acknowledged: self.is_acknowledged(), heard: self.heard.clone() }
    }
}

/// The answers that a probe has received.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Answers {
    /// Whether all readers have acknowledged.
    acknowledged: bool,
    /// Participants that it has received samples from.
    heard: BTreeSet<Prefix>,
}

impl Answers {
    /// Whether one of the `speakers` has not answered.
    fn lack(&self, speakers: &BTreeSet<Prefix>) -> bool {
        !self.acknowledged || !speakers.is_subset(&self.heard)
    }

    /// Whether a peer has answered this probe but not `first`.
    fn are_ahead_of(&self, first: &Answers) -> bool {
        (self.acknowledged && !first.acknowledged) || !self.heard.is_subset(&first.heard)
    }
}

/// The first probe of a connection, and the second one while a peer is suspected.
pub(super) struct Probes {
    first: Probe,
    second: Option<Probe>,
    verdict: Suspicion,
}

impl Probes {
    /// For a connection that has opened `first` before all other endpoints.
    pub fn new(first: Probe) -> Self {
        Probes { first, second: None, verdict: Suspicion::default() }
    }

    /// Whether a peer provably does not know our first endpoints. `present` has the peers that are present.
    pub fn look(&mut self, participant: &DomainParticipant, present: &BTreeSet<Prefix>) -> bool {
        // The order matters: a peer that answers both in between is then seen to have answered the first one too.
        let second = self.second.as_mut().map(Probe::answers);
        let first = self.first.answers();
        let silent = !present.is_subset(&first.heard);
        let speakers = if silent { speakers(participant, present) } else { BTreeSet::new() };
        let step = self.verdict.step(&first, second.as_ref(), &speakers, Instant::now());
        match step {
            Step::Wait => {}
            Step::Probe => self.second = Probe::open_in_time(participant),
            Step::Dismiss => let_go(self.second.take()),
            Step::Proven => return true,
        }
        false
    }
}

/// The participants among `present` that have a writer on the topic.
fn speakers(participant: &DomainParticipant, present: &BTreeSet<Prefix>) -> BTreeSet<Prefix> {
    let writers = participant.discovered_writers();
    let speaking =
        writers.iter().filter(|writer| writer.publication_topic_data.topic_name == ros_discovery::TOPIC_NAME);
    let prefixes = speaking.map(|writer| prefix_of(writer.writer_proxy.remote_writer_guid.prefix.as_ref()));
    prefixes.filter(|prefix| present.contains(prefix)).collect()
}

/// What to do next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Wait,
    Probe,
    Dismiss,
    Proven,
}

/// Start times of the current suspicion.
#[derive(Debug, Clone, Default)]
struct Suspicion {
    lacking_since: Option<Instant>,
    ahead_since: Option<Instant>,
}

impl Suspicion {
    fn step(&mut self, first: &Answers, second: Option<&Answers>, speakers: &BTreeSet<Prefix>, now: Instant) -> Step {
        if !first.lack(speakers) {
            *self = Suspicion::default();
            return if second.is_some() { Step::Dismiss } else { Step::Wait };
        }
        let lacking = now.duration_since(*self.lacking_since.get_or_insert(now));
        let Some(second) = second else {
            return if lacking >= ANSWER { Step::Probe } else { Step::Wait };
        };
        if !second.are_ahead_of(first) {
            self.ahead_since = None;
            return Step::Wait;
        }
        let ahead = now.duration_since(*self.ahead_since.get_or_insert(now));
        if ahead >= AHEAD { Step::Proven } else { Step::Wait }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PEER: Prefix = [1; 12];

    fn answers(acknowledged: bool, heard: &[Prefix]) -> Answers {
        Answers { acknowledged, heard: heard.iter().copied().collect() }
    }

    fn seconds(value: u64) -> Duration {
        Duration::from_secs(value)
    }

    #[test]
    fn a_peer_that_answers_is_not_suspected() {
        let (mut suspicion, start) = (Suspicion::default(), Instant::now());
        let speakers = BTreeSet::from([PEER]);
        let late = answers(false, &[]);
        assert_eq!(suspicion.step(&late, None, &speakers, start), Step::Wait);
        assert_eq!(suspicion.step(&late, None, &speakers, start + seconds(2)), Step::Wait);
        assert_eq!(suspicion.step(&answers(true, &[PEER]), None, &speakers, start + seconds(4)), Step::Wait);
        // It restarts from zero.
        assert_eq!(suspicion.step(&late, None, &speakers, start + seconds(5)), Step::Wait);
        assert_eq!(suspicion.step(&late, None, &speakers, start + seconds(8)), Step::Probe);
    }

    #[test]
    fn a_stopped_peer_answers_neither_probe_and_both_when_it_goes_on() {
        let (mut suspicion, start) = (Suspicion::default(), Instant::now());
        let speakers = BTreeSet::from([PEER]);
        let none = answers(false, &[]);
        assert_eq!(suspicion.step(&none, None, &speakers, start), Step::Wait);
        assert_eq!(suspicion.step(&none, None, &speakers, start + seconds(3)), Step::Probe);
        for second in 4..100 {
            assert_eq!(suspicion.step(&none, Some(&none), &speakers, start + seconds(second)), Step::Wait);
        }
        let both = answers(true, &[PEER]);
        assert_eq!(suspicion.step(&none, Some(&both), &speakers, start + seconds(100)), Step::Wait);
        assert_eq!(suspicion.step(&both, Some(&both), &speakers, start + seconds(101)), Step::Dismiss);
    }

    #[test]
    fn a_peer_that_answers_the_second_probe_alone_does_not_know_the_first() {
        for (first, second) in
            [(answers(false, &[PEER]), answers(true, &[PEER])), (answers(true, &[]), answers(true, &[PEER]))]
        {
            let (mut suspicion, start) = (Suspicion::default(), Instant::now());
            let speakers = BTreeSet::from([PEER]);
            assert_eq!(suspicion.step(&first, None, &speakers, start), Step::Wait);
            assert_eq!(suspicion.step(&first, None, &speakers, start + seconds(3)), Step::Probe);
            assert_eq!(suspicion.step(&first, Some(&second), &speakers, start + seconds(4)), Step::Wait);
            assert_eq!(suspicion.step(&first, Some(&second), &speakers, start + seconds(5)), Step::Proven);
        }
    }

    #[test]
    fn a_participant_without_a_writer_on_the_topic_owes_nothing() {
        let (mut suspicion, start) = (Suspicion::default(), Instant::now());
        let quiet = answers(true, &[]);
        assert_eq!(suspicion.step(&quiet, None, &BTreeSet::new(), start + seconds(9)), Step::Wait);
    }
}
