//! One file of a bag that is being written.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use mcap::records::MessageHeader;

use super::bag_writer::TopicToWrite;
use super::options::WriteOptions;
use crate::metadata::FileContents;
use crate::{BagError, Qos};

/// An MCAP file with its topics.
pub(super) struct Part {
    path: PathBuf,
    mcap: mcap::Writer<BufWriter<Counted>>,
    /// Bytes that have left for the operating system.
    written: Arc<AtomicU64>,
    /// Channel of each topic of the bag, in the bag's order.
    channels: Vec<u16>,
    contents: FileContents,
}

impl Part {
    /// Creates `name` in `folder`, which must not exist yet.
    pub fn create(folder: &std::path::Path, name: String, options: &WriteOptions) -> Result<Self, BagError> {
        let path = folder.join(&name);
        let file = File::create_new(&path).map_err(BagError::io("create", &path))?;
        let written = Arc::new(AtomicU64::new(0));
        let mcap = mcap::WriteOptions::new()
            .profile("ros2")
            .library(concat!("excavator ", env!("CARGO_PKG_VERSION")))
            .compression(options.compression.to_mcap())
            // Threads for compression cost more than they bring at the rates of a machine.
            .compression_threads(0)
            .chunk_size(Some(options.chunk_size))
            // No seeking: whole chunks only reach the file, never one with sizes still to be filled in.
            .disable_seeking(true)
            .create(BufWriter::new(Counted { file, written: Arc::clone(&written) }))
            .map_err(|source| BagError::Write { path: path.clone(), source })?;
        let contents = FileContents { name, span: None, message_count: 0 };
        Ok(Part { path, mcap, written, channels: Vec::new(), contents })
    }

    /// Adds the bag's next topic.
    pub fn add_topic(&mut self, topic: &TopicToWrite) -> Result<(), BagError> {
        let metadata = BTreeMap::from([("offered_qos_profiles".to_string(), Qos::list_to_yaml(&topic.qos))]);
        let channel = self
            .mcap
            .add_schema(&topic.type_name, "ros2msg", topic.schema.as_bytes())
            .and_then(|schema| self.mcap.add_channel(schema, &topic.name, "cdr", &metadata));
        self.channels.push(channel.map_err(|source| self.error(source))?);
        Ok(())
    }

    /// Writes a message of the bag's topic number `topic`.
    pub fn write(
        &mut self,
        topic: usize,
        sequence: u32,
        log_time: u64,
        publish_time: u64,
        data: &[u8],
    ) -> Result<(), BagError> {
        let Some(&channel_id) = self.channels.get(topic) else {
            return Err(self.error(mcap::McapError::UnknownChannel(0, 0)));
        };
        let header = MessageHeader { channel_id, sequence, log_time, publish_time };
        self.mcap.write_to_known_channel(&header, data).map_err(|source| self.error(source))?;
        let (start, end) = self.contents.span.unwrap_or((log_time, log_time));
        self.contents.span = Some((start.min(log_time), end.max(log_time)));
        self.contents.message_count += 1;
        Ok(())
    }

    /// Whether a message at `log_time` belongs into another file.
    pub fn is_full(&self, log_time: u64, options: &WriteOptions) -> bool {
        let Some((start, _)) = self.contents.span else { return false };
        options.most_file_bytes.is_some_and(|most| self.written.load(Ordering::Relaxed) >= most)
            || options.most_file_nanoseconds.is_some_and(|most| log_time.saturating_sub(start) >= most)
    }

    /// Closes the chunk and hands everything to the operating system.
    pub fn flush(&mut self) -> Result<(), BagError> {
        self.mcap.flush().map_err(|source| self.error(source))
    }

    /// Writes the index. Returns what the file has.
    pub fn finish(mut self) -> Result<FileContents, BagError> {
        self.mcap.finish().map_err(|source| self.error(source))?;
        // The library leaves the end of the file in our buffer; on a full disk it is here that writing fails.
        self.mcap
            .into_inner()
            .into_inner()
            .map_err(io::IntoInnerError::into_error)
            .and_then(|counted| counted.file.sync_all())
            .map_err(BagError::io("write", &self.path))?;
        Ok(self.contents)
    }

    fn error(&self, source: mcap::McapError) -> BagError {
        BagError::Write { path: self.path.clone(), source }
    }
}

/// A file that counts what is written to it.
struct Counted {
    file: File,
    written: Arc<AtomicU64>,
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.file.write(bytes)?;
        self.written.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

// The library asks for it, and does not seek when it is told not to.
impl io::Seek for Counted {
    fn seek(&mut self, position: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(position)
    }
}
