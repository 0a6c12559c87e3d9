//! A log of `candump -L` as the messages of a bag: one topic of frames for each device.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bytes::Bytes;
use excavator_msgs::{Header, Time};
use rosbag2::{RawMessage, Topic, cdr};
use serde::Serialize;
use socketcan::dump::{ParseError, Reader};
use socketcan::{CanAnyFrame, EmbeddedFrame, Frame as _};

/// Type of the messages: `can_msgs/msg/Frame`, but with the data that CAN FD has.
const FRAME_TYPE: &str = "can_msgs/msg/Frame";
const SCHEMA: &str =
    "std_msgs/Header header\nuint32 id\nbool is_rtr\nbool is_extended\nbool is_error\nuint8 dlc\nuint8[] data";

#[derive(Serialize)]
struct LoggedFrame {
    header: Header,
    id: u32,
    is_rtr: bool,
    is_extended: bool,
    is_error: bool,
    dlc: u8,
    data: Vec<u8>,
}

/// Whether a file is a log of `candump -L`, by its first line that is not empty: `(1700000000.000000) can0 123#0102`.
pub fn is_frame_log(path: &Path) -> bool {
    let is_record = |line: &str| {
        let mut words = line.split_whitespace();
        let is_time = words.next().is_some_and(|time| {
            let seconds = time.strip_prefix('(').and_then(|time| time.strip_suffix(')'));
            seconds.is_some_and(|seconds| seconds.contains('.') && seconds.parse::<f64>().is_ok())
        });
        let frame = words.nth(1).and_then(|frame| frame.split_once('#'));
        is_time && frame.is_some_and(|(id, _)| !id.is_empty() && id.bytes().all(|byte| byte.is_ascii_hexdigit()))
    };
    if !path.is_file() {
        return false;
    }
    let Ok(file) = File::open(path) else { return false };
    // A line of CAN FD has some 200 bytes.
    let mut start = Vec::new();
    if file.take(512).read_to_end(&mut start).is_err() {
        return false;
    }
    let text = String::from_utf8_lossy(&start);
    text.lines().find(|line| !line.trim().is_empty()).is_some_and(is_record)
}

/// The messages of a log.
pub(crate) struct FrameLog {
    path: PathBuf,
    reader: Reader<BufReader<File>>,
    topics: HashMap<String, Arc<Topic>>,
    /// Bytes of the file, and lines that are no records.
    pub bytes: u64,
    pub unreadable: u64,
}

impl FrameLog {
    /// Opens the log at `path`.
    ///
    /// # Errors
    /// [`rosbag2::Error::Io`].
    pub fn open(path: &Path) -> Result<FrameLog, rosbag2::Error> {
        let file = File::open(path).map_err(rosbag2::Error::io("open", path))?;
        let bytes = file.metadata().map(|metadata| metadata.len()).unwrap_or(0);
        let (path, reader) = (path.to_path_buf(), Reader::from_reader(file));
        Ok(FrameLog { path, reader, topics: HashMap::new(), bytes, unreadable: 0 })
    }

    /// The devices so far, as topics.
    pub fn topics(&self) -> Vec<Arc<Topic>> {
        let mut topics: Vec<Arc<Topic>> = self.topics.values().cloned().collect();
        topics.sort_by(|a, b| a.name.cmp(&b.name));
        topics
    }

    fn topic(&mut self, device: &str) -> Arc<Topic> {
        let new = || {
            Arc::new(Topic {
                name: format!("/{device}"),
                type_name: FRAME_TYPE.to_string(),
                schema_encoding: "ros2msg".to_string(),
                schema: SCHEMA.to_string(),
                message_encoding: "cdr".to_string(),
                offered_qos_profiles: String::new(),
            })
        };
        Arc::clone(self.topics.entry(device.to_string()).or_insert_with(new))
    }
}

impl Iterator for FrameLog {
    type Item = Result<RawMessage, rosbag2::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let record = match self.reader.next_record() {
                Ok(None) => return None,
                Err(ParseError::Io(error)) if error.kind() != ErrorKind::InvalidData => {
                    return Some(Err(rosbag2::Error::io("read", &self.path)(error)));
                }
                Err(_) => {
                    self.unreadable += 1;
                    continue;
                }
                Ok(Some(record)) => record,
            };
            let (frame, device, micros) = (record.frame, record.device.to_string(), record.t_us);
            let data = match &frame {
                CanAnyFrame::Normal(frame) => frame.data().to_vec(),
                CanAnyFrame::Fd(frame) => frame.data().to_vec(),
                CanAnyFrame::Remote(_) | CanAnyFrame::Error(_) => Vec::new(),
            };
            let nanoseconds = micros.saturating_mul(1000);
            let message = LoggedFrame {
                header: Header {
                    stamp: i64::try_from(nanoseconds).ok().and_then(Time::from_nanoseconds).unwrap_or_default(),
                    frame_id: String::new(),
                },
                id: frame.raw_id(),
                is_rtr: matches!(frame, CanAnyFrame::Remote(_)),
                is_extended: EmbeddedFrame::is_extended(&frame),
                is_error: matches!(frame, CanAnyFrame::Error(_)),
                dlc: u8::try_from(data.len()).unwrap_or(u8::MAX),
                data,
            };
            let Ok(bytes) = cdr::encode(&message) else {
                self.unreadable += 1;
                continue;
            };
            return Some(Ok(RawMessage {
                topic: self.topic(&device),
                sequence: 0,
                log_time: nanoseconds,
                publish_time: nanoseconds,
                data: Bytes::from(bytes),
            }));
        }
    }
}
