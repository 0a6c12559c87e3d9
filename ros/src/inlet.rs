//! A subscription that outlives its connection.

use std::collections::{BTreeSet, HashMap};
use std::pin::pin;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use excavator_msgs::Message;
use futures::StreamExt;
use ros2_client::Gid;
use rustdds::DomainParticipant;

use super::arrivals::Writer;
use super::connection::{Closed, Connection, Endpoint, Install, Tended};
use super::dds_names::{dds_topic, dds_type};
use super::readers::Readers;
use super::{RosError, TopicQos};

/// Metadata of a received message.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Received {
    /// Time of reception, on the monotonic clock of this machine.
    pub at: Instant,
    /// Time of publication, ns since the epoch by the clock of the publisher, if the publisher sends it.
    pub published: Option<i64>,
    /// The publisher.
    pub publisher: Gid,
    /// Sequence number of the publisher.
    pub sequence: i64,
}

/// Called for each message on the thread of the link; must be brief.
type Callback<M> = Box<dyn FnMut(M, Received) + Send>;

pub(super) struct Inlet<M> {
    topic: String,
    qos: TopicQos,
    callback: Arc<Mutex<Callback<M>>>,
    undecodable: Arc<AtomicU64>,
    readers: Readers,
}

impl<M: Message + Send + 'static> Inlet<M> {
    pub(super) fn new(topic: String, qos: TopicQos, callback: Callback<M>) -> Self {
        let callback = Arc::new(Mutex::new(callback));
        Inlet { topic, qos, callback, undecodable: Arc::default(), readers: Readers::default() }
    }

    /// Number of messages so far that could not be decoded or had another type.
    pub(super) fn undecodable(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.undecodable)
    }
}

impl<M: Message + Send + Sync + 'static> Endpoint for Inlet<M> {
    fn open(self: Arc<Self>, connection: &mut Connection) -> Result<Install, RosError> {
        let failed = |reason: String| RosError::Endpoint { what: self.topic.clone(), reason };
        let wanted_type = dds_type(M::TYPE_NAME);
        let topic =
            connection.create_topic(&dds_topic(&self.topic), &wanted_type, &self.qos.to_dds()).map_err(failed)?;
        let subscription =
            connection.node().create_subscription::<M>(&topic, None).map_err(|error| failed(error.to_string()))?;
        let callback = Arc::clone(&self.callback);
        let undecodable = Arc::clone(&self.undecodable);
        let mut types = WriterTypes::new(connection.participant(), wanted_type);
        let (readers, number) = (Arc::clone(&self), self.readers.enter());
        let reading = async move {
            let mut messages = pin!(subscription.async_stream());
            while let Some(message) = messages.next().await {
                match message {
                    Ok((message, info)) if types.fits(info.publisher_gid()) => {
                        let writer = info.publisher_gid().to_bytes16();
                        if !readers.readers.take(number, writer, info.sequence_number()) {
                            continue;
                        }
                        let received = Received {
                            at: Instant::now(),
                            published: info.source_timestamp().map(|time| time.to_nanos()),
                            publisher: info.publisher_gid(),
                            sequence: info.sequence_number(),
                        };
                        (callback.lock().unwrap_or_else(PoisonError::into_inner))(message, received);
                    }
                    Ok(_) => {
                        undecodable.fetch_add(1, Ordering::Relaxed);
                    }
                    Err(_) => {
                        undecodable.fetch_add(1, Ordering::Relaxed);
                        // A reader with a permanent fault fails at once on every call.
                        tokio::time::sleep(Duration::from_millis(1)).await;
                    }
                }
            }
        };
        Ok(Box::new(move |runtime| {
            self.readers.install(number, runtime.spawn(reading));
        }))
    }

    fn close(&self) -> Closed {
        self.readers.close()
    }

    fn tend(&self, present: &mut dyn FnMut() -> BTreeSet<Writer>) -> Tended {
        self.readers.tend(&self.topic, present)
    }

    fn interface(&self) -> Option<(String, String)> {
        Some((self.topic.clone(), M::TYPE_NAME.to_string()))
    }
}

/// Types of the writers. The middleware matches by topic name alone, so messages of a writer with another type would be
/// decoded into wrong values.
struct WriterTypes {
    participant: DomainParticipant,
    wanted: String,
    known: HashMap<Gid, bool>,
}

impl WriterTypes {
    fn new(participant: DomainParticipant, wanted: String) -> Self {
        WriterTypes { participant, wanted, known: HashMap::new() }
    }

    fn fits(&mut self, writer: Gid) -> bool {
        if let Some(&fits) = self.known.get(&writer) {
            return fits;
        }
        let writers = self.participant.discovered_writers();
        let found = writers.iter().find(|data| Gid::from(data.publication_topic_data.key) == writer);
        // A writer that discovery does not know (yet) is in this process, or is looked up again with its next message.
        let Some(found) = found else { return true };
        let fits = found.publication_topic_data.type_name == self.wanted;
        self.known.insert(writer, fits);
        fits
    }
}
