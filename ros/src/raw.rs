//! Readers and writers of topics of any type.

use std::collections::BTreeSet;
use std::pin::pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use futures::StreamExt;
use rustdds::bytes::Bytes;
use rustdds::no_key::DataWriter;
use rustdds::policy::Durability;
use rustdds::{GUID, QosPolicies, Timestamp, WriteOptionsBuilder};

use super::arrivals::Writer;
use super::clock::system_nanoseconds;
use super::connection::{Closed, Connection, Endpoint, Install, Tended};
use super::dds_names::{dds_topic, dds_type};
use super::raw_bytes::{RawAdapter, RawBytes};
use super::readers::Readers;
use super::{Link, PublishError, RosError};

/// A message as received.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RawSample {
    /// Content with encapsulation.
    pub data: Bytes,
    /// Time of reception, ns since the epoch, system clock.
    pub received: u64,
    /// Time of publication, ns since the epoch, by the clock of the publisher.
    pub published: Option<u64>,
    /// The publisher.
    pub writer: [u8; 16],
    /// Sequence number of the publisher.
    pub sequence: i64,
}

type Callback = Box<dyn FnMut(RawSample) + Send>;

/// A reader of one topic of any type.
pub struct RawInlet {
    /// Name and type in DDS.
    topic: String,
    type_name: String,
    qos: QosPolicies,
    callback: Arc<Mutex<Callback>>,
    readers: Readers,
}

impl RawInlet {
    /// Reads `topic` (full name) of `type_name` (ROS name) from now on; `callback` runs on the thread of the link.
    pub fn open(
        link: &Link,
        topic: &str,
        type_name: &str,
        qos: QosPolicies,
        callback: impl FnMut(RawSample) + Send + 'static,
    ) -> Result<(), RosError> {
        RawInlet::open_dds(link, &dds_topic(topic), &dds_type(type_name), qos, callback)
    }

    /// Reads a topic given by its DDS names.
    pub fn open_dds(
        link: &Link,
        dds_topic: &str,
        dds_type: &str,
        qos: QosPolicies,
        callback: impl FnMut(RawSample) + Send + 'static,
    ) -> Result<(), RosError> {
        link.add(Arc::new(RawInlet {
            topic: dds_topic.to_string(),
            type_name: dds_type.to_string(),
            qos,
            callback: Arc::new(Mutex::new(Box::new(callback))),
            readers: Readers::default(),
        }))
    }
}

impl Endpoint for RawInlet {
    fn open(self: Arc<Self>, connection: &mut Connection) -> Result<Install, RosError> {
        let failed = |reason: String| RosError::Endpoint { what: self.topic.clone(), reason };
        let topic = connection.create_topic(&self.topic, &self.type_name, &self.qos).map_err(failed)?;
        let subscriber =
            connection.participant().create_subscriber(&self.qos).map_err(|error| failed(error.to_string()))?;
        let reader = subscriber
            .create_simple_datareader_no_key::<RawBytes, RawAdapter>(&topic, Some(self.qos.clone()))
            .map_err(|error| failed(error.to_string()))?;
        let callback = Arc::clone(&self.callback);
        let (readers, number) = (Arc::clone(&self), self.readers.enter());
        let reading = async move {
            let mut samples = pin!(reader.as_async_stream());
            while let Some(sample) = samples.next().await {
                let Ok(sample) = sample else {
                    tokio::time::sleep(Duration::from_millis(1)).await;
                    continue;
                };
                let raw = RawSample {
                    received: u64::try_from(system_nanoseconds()).unwrap_or_default(),
                    published: sample.source_timestamp().and_then(nanoseconds),
                    writer: ros2_client::Gid::from(sample.writer_guid()).to_bytes16(),
                    sequence: i64::from(sample.sequence_number),
                    data: sample.into_value().0,
                };
                if readers.readers.take(number, raw.writer, raw.sequence) {
                    (callback.lock().unwrap_or_else(PoisonError::into_inner))(raw);
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
}

fn nanoseconds(time: Timestamp) -> Option<u64> {
    ros2_client::ROSTime::try_from(time).ok().and_then(|time| u64::try_from(time.to_nanos()).ok())
}

/// A writer of one topic of any type.
pub struct RawOutlet {
    topic: String,
    type_name: String,
    qos: QosPolicies,
    writer: Mutex<Option<DataWriter<RawBytes, RawAdapter>>>,
}

impl RawOutlet {
    /// A writer of `topic` (full name) of `type_name` (ROS name).
    pub fn open(link: &Link, topic: &str, type_name: &str, qos: QosPolicies) -> Result<Arc<Self>, RosError> {
        let (topic, type_name) = (topic.to_string(), type_name.to_string());
        let outlet = Arc::new(RawOutlet { topic, type_name, qos, writer: Mutex::new(None) });
        link.add(Arc::clone(&outlet) as Arc<dyn Endpoint>)?;
        Ok(outlet)
    }

    /// Publishes a message with its encapsulation, which must be that of plain little endian CDR.
    pub fn publish(&self, data: Bytes) -> Result<(), PublishError> {
        if data.get(..2) != Some(&[0, 1]) {
            return Err(PublishError::Failed("the message is not plain CDR in little endian".to_string()));
        }
        let slot = self.writer.lock().unwrap_or_else(PoisonError::into_inner);
        let writer = slot.as_ref().ok_or(PublishError::Down)?;
        writer.write(RawBytes(data), Some(Timestamp::now())).map_err(|error| match error {
            rustdds::dds::WriteError::WouldBlock { .. } => PublishError::Full,
            other => PublishError::Failed(other.to_string()),
        })
    }

    /// Waits until readers have acknowledged all published messages.
    pub fn wait_for_readers(&self, time: Duration) {
        let slot = self.writer.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(writer) = slot.as_ref() {
            // Readers that have not acknowledged in time do not delay the end.
            let _ = writer.wait_for_acknowledgments(time);
        }
    }
}

/// Uses up the first sequence number without a receiver, so that the writer has something to announce in its
/// heartbeats.
///
/// Eclipse Cyclone DDS drops the samples of a reliable writer that arrive before its first heartbeat. RustDDS does not
/// answer the ACKNACK of a reader with a heartbeat while nothing has been written. Without this call, the first message
/// is lost whenever the reader discovers the writer after the writer has discovered the reader.
fn announce(writer: &DataWriter<RawBytes, RawAdapter>) {
    let nobody = WriteOptionsBuilder::new().to_single_reader(GUID::GUID_UNKNOWN).build();
    // A writer that refuses this sample also refuses the following messages, which are counted there.
    let _ = writer.write_with_options(RawBytes(Bytes::from_static(&[0, 1, 0, 0])), nobody);
}

impl Endpoint for RawOutlet {
    fn open(self: Arc<Self>, connection: &mut Connection) -> Result<Install, RosError> {
        let failed = |reason: String| RosError::Endpoint { what: self.topic.clone(), reason };
        let topic =
            connection.create_topic(&dds_topic(&self.topic), &dds_type(&self.type_name), &self.qos).map_err(failed)?;
        let publisher =
            connection.participant().create_publisher(&self.qos).map_err(|error| failed(error.to_string()))?;
        let writer = publisher
            .create_datawriter_no_key::<RawBytes, RawAdapter>(&topic, Some(self.qos.clone()))
            .map_err(|error| failed(error.to_string()))?;
        if self.qos.durability() != Some(Durability::TransientLocal) {
            announce(&writer);
        }
        Ok(Box::new(move |_| {
            *self.writer.lock().unwrap_or_else(PoisonError::into_inner) = Some(writer);
        }))
    }

    fn close(&self) -> Closed {
        Closed::writer(self.writer.lock().unwrap_or_else(PoisonError::into_inner).take())
    }
}
