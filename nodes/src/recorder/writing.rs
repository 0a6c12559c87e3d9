//! The writing thread. It alone accesses the disk, so that a slow disk delays no other thread.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use excavator_msgs::definitions;
use rosbag2::{BagWriter, GoneFile, Qos, TopicId, TopicToWrite};

use super::losses::Losses;
use excavator_ros::raw::RawSample;

/// Time between two flushes: the most that a killed recorder loses, apart from the duration of the flush.
const FLUSH: Duration = Duration::from_millis(500);

/// An order to the writing thread.
pub(super) enum Order {
    /// A topic; its number is the count of topics before it. The QoS is the one offered now: the file stores it at its
    /// beginning, and readers do not find the messages of a bag whose metadata contradict its file.
    Topic { name: String, type_name: String, qos: Vec<Qos> },
    /// A message of a topic.
    Message { topic: usize, sample: RawSample },
    /// The end. It is sent explicitly, because a connection that hangs keeps its readers, and so their senders, for ever.
    End,
}

/// The result of a recording.
#[derive(Debug)]
pub(super) struct Outcome {
    pub topics: Vec<TopicOutcome>,
    /// Files that are no longer in their places.
    pub gone: Vec<GoneFile>,
}

/// The result of the recording of a topic.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TopicOutcome {
    /// Full name.
    pub name: String,
    /// Messages in the bag.
    pub messages: u64,
    /// Messages in files that were deleted or moved.
    pub gone: u64,
    /// Messages that were published and did not arrive.
    pub lost: u64,
    /// Number of publishers that sent messages.
    pub publishers: usize,
}

struct Recorded {
    id: TopicId,
    outcome: TopicOutcome,
    losses: Losses,
}

/// Writes until the end is sent, then closes the bag, also after a write error. `dropped` returns the number of messages for
/// which the recorder had no room. `on_gone` is called for a file that is no longer in its place.
pub(super) fn write(
    mut bag: BagWriter,
    orders: &Receiver<Order>,
    dropped: impl Fn() -> u64,
    on_gone: impl Fn(&GoneFile),
) -> Result<Outcome, rosbag2::Error> {
    let mut topics: Vec<Recorded> = Vec::new();
    let written = take_orders(&mut bag, orders, &mut topics, on_gone);
    for topic in &mut topics {
        topic.outcome.lost = topic.losses.lost();
        topic.outcome.publishers = topic.losses.publishers();
        bag.set_custom_data(&format!("lost_messages:{}", topic.outcome.name), &topic.outcome.lost.to_string());
        let silence = format!("{:.3}", topic.losses.longest_silence());
        bag.set_custom_data(&format!("longest_silence_seconds:{}", topic.outcome.name), &silence);
    }
    bag.set_custom_data("dropped_by_recorder", &dropped().to_string());
    if let Err(error) = &written {
        bag.set_custom_data("ended_by", &error.to_string());
    }
    let closed = bag.finish();
    // An error of the write comes first: it is the cause of one at the close.
    written?;
    let gone = closed?;
    for (index, topic) in topics.iter_mut().enumerate() {
        topic.outcome.gone = gone.iter().filter_map(|file| file.by_topic.get(index)).sum();
        topic.outcome.messages = topic.outcome.messages.saturating_sub(topic.outcome.gone);
    }
    Ok(Outcome { topics: topics.into_iter().map(|topic| topic.outcome).collect(), gone })
}

fn take_orders(
    bag: &mut BagWriter,
    orders: &Receiver<Order>,
    topics: &mut Vec<Recorded>,
    on_gone: impl Fn(&GoneFile),
) -> Result<(), rosbag2::Error> {
    let mut flushed = Instant::now();
    loop {
        match orders.recv_timeout(FLUSH.saturating_sub(flushed.elapsed())) {
            Ok(Order::Topic { name, type_name, qos }) => {
                let schema = definitions::schema(&type_name).unwrap_or_default();
                let id = bag.add_topic(&TopicToWrite { name: name.clone(), type_name, schema, qos })?;
                let outcome = TopicOutcome { name, messages: 0, gone: 0, lost: 0, publishers: 0 };
                topics.push(Recorded { id, outcome, losses: Losses::default() });
            }
            Ok(Order::Message { topic, sample }) => {
                let Some(topic) = topics.get_mut(topic) else { continue };
                topic.losses.take(sample.writer, sample.sequence, sample.received);
                topic.outcome.messages += 1;
                bag.write(topic.id, sample.received, sample.published.unwrap_or(sample.received), &sample.data)?;
            }
            Err(RecvTimeoutError::Timeout) => {}
            Ok(Order::End) | Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        if flushed.elapsed() >= FLUSH {
            bag.flush()?;
            if let Some(gone) = bag.stay_in_place()? {
                on_gone(gone);
            }
            flushed = Instant::now();
        }
    }
}
