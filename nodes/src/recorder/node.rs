//! The recorder's node.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rosbag2::{BagWriter, WriteOptions};

use super::offered::{OfferedTopic, asked, topics};
use super::selection::Selection;
use super::writing::{Order, Outcome, write};
use crate::error::NodeError;
use excavator_ros::raw::RawInlet;
use excavator_ros::{Health, RosArguments, Supervisor};

/// Time between two searches for new topics.
const LOOK: Duration = Duration::from_millis(200);
/// Messages that may wait to be written: a minute at 1 kHz.
const WAITING: usize = 60_000;

/// What is recorded, and where to.
#[derive(Debug, Clone, Default)]
pub struct RecordingOptions {
    /// Names of topics, seen from the namespace of the node; with neither names nor a pattern, all topics are recorded.
    pub topics: Vec<String>,
    /// Also topics whose whole name matches this regular expression.
    pub pattern: Option<String>,
    /// Not those whose whole name matches this one.
    pub exclude: Option<String>,
    /// Also topics with a part that begins with an underscore.
    pub hidden_topics: bool,
    /// Bag to write; without, its name is `rosbag2_` and the time.
    pub bag: Option<PathBuf>,
    /// Time after which the recording ends, s.
    pub duration: Option<f64>,
    /// How the bag is written.
    pub writing: WriteOptions,
}

/// Records until a stop is requested, or for the given duration.
///
/// # Errors
/// [`NodeError`] if it cannot start, or the bag cannot be written.
pub fn run(options: &RecordingOptions, ros: &RosArguments) -> Result<(), NodeError> {
    let supervisor = Supervisor::start_large("bag_recorder", ros, Vec::new())?;
    let full = |name: &String| supervisor.link.identity().resolve(name);
    let names = options.topics.iter().map(full).collect::<Result<_, _>>()?;
    let selection =
        Selection::new(names, options.pattern.as_deref(), options.exclude.as_deref(), options.hidden_topics)?;
    let folder = options.bag.clone().unwrap_or_else(default_folder);
    let bag = BagWriter::create(&folder, &options.writing)?;
    supervisor.logger.info(format!("recording to {}", folder.display()));
    let dropped = Arc::new(AtomicU64::new(0));
    let gone = Mutex::new(None);
    let (sender, orders) = sync_channel(WAITING);
    let last = sender.clone();
    let stop = supervisor.stop_flag();
    let outcome = std::thread::scope(|scope| {
        let counter = Arc::clone(&dropped);
        let stop_on_failure = Arc::clone(&stop);
        let (logger, gone_here) = (&supervisor.logger, &gone);
        let writing = scope.spawn(move || {
            let outcome = write(
                bag,
                &orders,
                || counter.load(Ordering::Relaxed),
                |file| {
                    logger.error(format!("{file} was deleted or moved; recording goes on in another file of the bag"));
                    *gone_here.lock().unwrap_or_else(PoisonError::into_inner) = Some(file.to_string());
                },
            );
            stop_on_failure.store(true, Ordering::Relaxed);
            outcome
        });
        let looking = scope.spawn(|| {
            let mut recorder =
                Recorder { supervisor: &supervisor, selection, sender, dropped, gone: &gone, known: Vec::new() };
            let end = options.duration.map(|seconds| Instant::now() + Duration::from_secs_f64(seconds));
            while !stop.load(Ordering::Relaxed) {
                recorder.look();
                std::thread::sleep(LOOK);
                if end.is_some_and(|end| Instant::now() >= end) {
                    stop.store(true, Ordering::Relaxed);
                }
            }
            recorder.missing()
        });
        supervisor.run(|| {});
        let missing = looking.join().unwrap_or_default();
        supervisor.link.forget_endpoints();
        // Sending fails if the writing thread has failed.
        let _ = last.send(Order::End);
        (writing.join(), missing)
    });
    let (written, missing) = outcome;
    for name in missing {
        supervisor.logger.warn(format!("nobody published {name}"));
    }
    let result = match written {
        Ok(written) => written.map_err(NodeError::from).and_then(|outcome| tell(&supervisor, &folder, &outcome)),
        Err(_) => Ok(()),
    };
    supervisor.leave();
    result
}

fn tell(supervisor: &Supervisor, folder: &Path, outcome: &Outcome) -> Result<(), NodeError> {
    let topics = &outcome.topics;
    let total: u64 = topics.iter().map(|topic| topic.messages).sum();
    for topic in topics {
        let gone = if topic.gone > 0 { format!(", {} in files that are gone", topic.gone) } else { String::new() };
        supervisor.logger.info(format!(
            "{}: {} messages of {} publishers, {} lost{gone}",
            topic.name, topic.messages, topic.publishers, topic.lost
        ));
    }
    supervisor.logger.info(format!("{total} messages on {} topics", topics.len()));
    if outcome.gone.is_empty() {
        return Ok(());
    }
    let files: Vec<String> = outcome.gone.iter().map(ToString::to_string).collect();
    Err(NodeError::RecordingGone { bag: folder.to_path_buf(), files: files.join(", ") })
}

/// A name such as `rosbag2_2026_11_21-06_00_00`, as `ros2 bag record` uses it.
fn default_folder() -> PathBuf {
    PathBuf::from(jiff::Zoned::now().strftime("rosbag2_%Y_%m_%d-%H_%M_%S").to_string())
}

struct Recorder<'r> {
    supervisor: &'r Supervisor,
    selection: Selection,
    sender: SyncSender<Order>,
    dropped: Arc<AtomicU64>,
    /// The file that disappeared last.
    gone: &'r Mutex<Option<String>>,
    known: Vec<OfferedTopic>,
}

impl Recorder<'_> {
    fn look(&mut self) {
        let Some(participant) = self.supervisor.link.participant() else { return };
        // This process's own topics (log, diagnostics) are not recorded.
        let own = participant_prefix(&participant);
        let mut writers = participant.discovered_writers();
        writers.retain(|writer| writer.publication_topic_data.key.prefix.as_ref() != own.as_slice());
        for topic in topics(&writers) {
            if !self.selection.takes(&topic.name) {
                continue;
            }
            if !self.known.iter().any(|known| known.name == topic.name) {
                self.add(topic);
            }
        }
        let values = [
            ("topics", self.known.len().to_string()),
            ("dropped messages", self.dropped.load(Ordering::Relaxed).to_string()),
        ];
        let gone = self.gone.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let (health, message) = match gone {
            Some(file) => (Health::Error, format!("{file} was deleted or moved")),
            None if self.dropped.load(Ordering::Relaxed) > 0 => (Health::Warning, "the disk is too slow".to_string()),
            None => (Health::Ok, "recording".to_string()),
        };
        self.supervisor.diagnostics.tell("recorder", health, message, &values);
    }

    fn add(&mut self, topic: OfferedTopic) {
        let logger = &self.supervisor.logger;
        if excavator_msgs::definitions::schema(&topic.type_name).is_none() {
            logger.warn(format!(
                "{}: no definition of {} is known here; its bytes are recorded",
                topic.name, topic.type_name
            ));
        }
        for other in &topic.other_types {
            logger.warn(format!("{} is also published as {other}, which is not recorded", topic.name));
        }
        let index = self.known.len();
        let order =
            Order::Topic { name: topic.name.clone(), type_name: topic.type_name.clone(), qos: topic.qos.clone() };
        if self.sender.send(order).is_err() {
            return;
        }
        let (sender, dropped) = (self.sender.clone(), Arc::clone(&self.dropped));
        let taken = move |sample| match sender.try_send(Order::Message { topic: index, sample }) {
            Ok(()) | Err(TrySendError::Disconnected(_)) => {}
            Err(TrySendError::Full(_)) => {
                dropped.fetch_add(1, Ordering::Relaxed);
            }
        };
        match RawInlet::open(&self.supervisor.link, &topic.name, &topic.type_name, asked(&topic.qos), taken) {
            Ok(()) => logger.info(format!("recording {} ({})", topic.name, topic.type_name)),
            Err(error) => logger.error(error.to_string()),
        }
        self.known.push(topic);
    }

    fn missing(&self) -> Vec<String> {
        let never = |name: &&String| !self.known.iter().any(|known| known.name == **name);
        self.selection.names().iter().filter(never).cloned().collect()
    }
}

fn participant_prefix(participant: &rustdds::DomainParticipant) -> Vec<u8> {
    use rustdds::RTPSEntity;
    participant.guid().prefix.as_ref().to_vec()
}
