//! A publisher that outlives its connection.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use excavator_msgs::Message;
use ros2_client::{Publisher, WriteError};

use super::connection::{Closed, Connection, Endpoint, Install};
use super::dds_names::{dds_topic, dds_type};
use super::{RosError, TopicQos};

/// Why a message was not published.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PublishError {
    /// Readers are too far behind.
    #[error("readers are too far behind, the send window is full")]
    Full,
    /// The link is being built.
    #[error("the link is being rebuilt")]
    Down,
    /// Anything else.
    #[error("{0}")]
    Failed(String),
}

/// A publisher of one topic; clones share it.
pub struct Outlet<M: Message> {
    shared: Arc<Shared<M>>,
}

struct Shared<M: Message> {
    topic: String,
    qos: TopicQos,
    publisher: Mutex<Option<Publisher<M>>>,
    published: AtomicU64,
    refused: AtomicU64,
}

impl<M: Message> Clone for Outlet<M> {
    fn clone(&self) -> Self {
        Outlet { shared: Arc::clone(&self.shared) }
    }
}

impl<M: Message + Send + Sync + 'static> Outlet<M> {
    pub(super) fn new(topic: String, qos: TopicQos) -> Self {
        let counts = (AtomicU64::new(0), AtomicU64::new(0));
        let publisher = Mutex::new(None);
        Outlet { shared: Arc::new(Shared { topic, qos, publisher, published: counts.0, refused: counts.1 }) }
    }

    /// Publishes without blocking.
    ///
    /// # Errors
    /// [`PublishError`]. The message is then lost, and [`Outlet::refused`] counts it.
    pub fn publish(&self, message: M) -> Result<(), PublishError> {
        let slot = self.shared.publisher.lock().unwrap_or_else(PoisonError::into_inner);
        let result = match slot.as_ref() {
            None => Err(PublishError::Down),
            Some(publisher) => publisher.publish(message).map_err(|error| match error {
                WriteError::WouldBlock { .. } => PublishError::Full,
                other => PublishError::Failed(other.to_string()),
            }),
        };
        let counter = if result.is_ok() { &self.shared.published } else { &self.shared.refused };
        counter.fetch_add(1, Ordering::Relaxed);
        result
    }

    /// Number of messages published so far.
    pub fn published(&self) -> u64 {
        self.shared.published.load(Ordering::Relaxed)
    }

    /// Number of messages refused so far, for any reason.
    pub fn refused(&self) -> u64 {
        self.shared.refused.load(Ordering::Relaxed)
    }

    /// Full name of the topic.
    pub fn topic(&self) -> &str {
        &self.shared.topic
    }
}

impl<M: Message + Send + Sync + 'static> Endpoint for Outlet<M> {
    fn open(self: Arc<Self>, connection: &mut Connection) -> Result<Install, RosError> {
        let failed = |reason: String| RosError::Endpoint { what: self.shared.topic.clone(), reason };
        let topic = connection
            .create_topic(&dds_topic(&self.shared.topic), &dds_type(M::TYPE_NAME), &self.shared.qos.to_dds())
            .map_err(failed)?;
        let publisher = connection.node().create_publisher(&topic, None).map_err(|error| failed(error.to_string()))?;
        Ok(Box::new(move |_| {
            *self.shared.publisher.lock().unwrap_or_else(PoisonError::into_inner) = Some(publisher);
        }))
    }

    fn close(&self) -> Closed {
        Closed::writer(self.shared.publisher.lock().unwrap_or_else(PoisonError::into_inner).take())
    }

    fn interface(&self) -> Option<(String, String)> {
        Some((self.shared.topic.clone(), M::TYPE_NAME.to_string()))
    }
}
