//! One file of a bag during writing.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter};
use std::os::unix::fs::{FileExt, MetadataExt};
use std::path::{Path, PathBuf};

use mcap::records::MessageHeader;

use super::counted::{Counted, Progress};
use super::options::WriteOptions;
use super::topic_to_write::TopicToWrite;
use crate::metadata::FileContents;
use crate::{Error, Qos};

/// The contents of a bag file.
#[derive(Debug, Clone)]
pub(super) struct Written {
    pub contents: FileContents,
    /// Number of messages per topic, in the topic order of the bag.
    pub by_topic: Vec<u64>,
    /// Size of the file, bytes.
    pub bytes: u64,
}

/// Whether a file is where it was created.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Location {
    path: PathBuf,
    identity: (u64, u64),
}

impl Location {
    /// Whether the path still refers to the file. Also true if the system cannot report it.
    pub fn is_kept(&self) -> bool {
        match self.path.symlink_metadata() {
            Ok(found) => (found.dev(), found.ino()) == self.identity,
            Err(error) => !matches!(
                error.kind(),
                io::ErrorKind::NotFound | io::ErrorKind::NotADirectory | io::ErrorKind::StaleNetworkFileHandle
            ),
        }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// An MCAP file with its topics.
pub(super) struct Part {
    location: Location,
    mcap: mcap::Writer<BufWriter<Counted>>,
    /// The same file, to close it if the library cannot.
    file: File,
    progress: Progress,
    /// Channel of each topic, in the topic order of the bag.
    channels: Vec<u16>,
    written: Written,
    /// The contents of the file at the last flush, all of which were written.
    flushed: Written,
}

impl Part {
    /// Creates `name`, which must not exist yet, in `folder`.
    pub fn create(folder: &Path, name: String, options: &WriteOptions) -> Result<Self, Error> {
        let path = folder.join(&name);
        let opened = || {
            let file = File::create_new(&path)?;
            let found = file.metadata()?;
            Ok((file.try_clone()?, file, (found.dev(), found.ino())))
        };
        let (file, same_file, identity) = opened().map_err(Error::io("create", &path))?;
        let progress = Progress::default();
        let mcap = mcap::WriteOptions::new()
            .profile("ros2")
            .library(concat!("excavator ", env!("CARGO_PKG_VERSION")))
            .compression(options.compression.to_mcap())
            // Compression threads cost more than they save at the data rates of a machine.
            .compression_threads(0)
            .chunk_size(Some(options.chunk_size))
            // No seeking: only whole chunks are written, never one whose sizes are filled in later.
            .disable_seeking(true)
            .create(BufWriter::new(Counted::new(same_file, &progress)))
            .map_err(|source| Error::Write { path: path.clone(), source })?;
        let contents = FileContents { name, span: None, message_count: 0 };
        let written = Written { contents, by_topic: Vec::new(), bytes: 0 };
        let location = Location { path, identity };
        let mut part = Part { location, mcap, file, progress, channels: Vec::new(), flushed: written.clone(), written };
        part.flush()?;
        Ok(part)
    }

    /// Adds the bag's next topic.
    pub fn add_topic(&mut self, topic: &TopicToWrite) -> Result<(), Error> {
        let metadata = BTreeMap::from([("offered_qos_profiles".to_string(), Qos::list_to_yaml(&topic.qos))]);
        let channel = self
            .mcap
            .add_schema(&topic.type_name, "ros2msg", topic.schema.as_bytes())
            .and_then(|schema| self.mcap.add_channel(schema, &topic.name, "cdr", &metadata));
        self.channels.push(channel.map_err(|source| self.error(source))?);
        self.written.by_topic.push(0);
        Ok(())
    }

    /// Writes a message of topic number `topic` of the bag.
    pub fn write(
        &mut self,
        topic: usize,
        sequence: u32,
        log_time: u64,
        publish_time: u64,
        data: &[u8],
    ) -> Result<(), Error> {
        let (Some(&channel_id), Some(count)) = (self.channels.get(topic), self.written.by_topic.get_mut(topic)) else {
            return Err(self.error(mcap::McapError::UnknownChannel(0, 0)));
        };
        let header = MessageHeader { channel_id, sequence, log_time, publish_time };
        *count += 1;
        self.mcap.write_to_known_channel(&header, data).map_err(|source| self.error(source))?;
        let contents = &mut self.written.contents;
        let (start, end) = contents.span.unwrap_or((log_time, log_time));
        contents.span = Some((start.min(log_time), end.max(log_time)));
        contents.message_count += 1;
        Ok(())
    }

    /// Whether a message at `log_time` belongs in another file.
    pub fn is_full(&self, log_time: u64, options: &WriteOptions) -> bool {
        let Some((start, _)) = self.written.contents.span else { return false };
        options.most_file_bytes.is_some_and(|most| self.progress.bytes() >= most)
            || options.most_file_nanoseconds.is_some_and(|most| log_time.saturating_sub(start) >= most)
    }

    /// Where the file was created.
    pub fn location(&self) -> &Location {
        &self.location
    }

    /// Closes the chunk and passes all data to the operating system.
    pub fn flush(&mut self) -> Result<(), Error> {
        self.mcap.flush().map_err(|source| self.error(source))?;
        self.written.bytes = self.progress.bytes();
        self.flushed = self.written.clone();
        Ok(())
    }

    /// Writes the index. If that fails, or writing failed before, the file ends after its contents at the last flush,
    /// without an index. Returns the contents of the file, and the error of this call.
    pub fn finish(mut self) -> (Written, Result<(), Error>) {
        let failed_before = self.progress.failure().is_some();
        let finished =
            if failed_before { Ok(()) } else { self.mcap.finish().map(drop).map_err(|source| self.error(source)) };
        let Part { location, mcap, file, progress, mut written, flushed, .. } = self;
        let buffer = mcap.into_inner();
        if finished.is_ok() && !failed_before {
            // The library leaves the end of the file in our buffer; on a full disk, this write fails.
            let ended = buffer.into_inner().map_err(io::IntoInnerError::into_error).and_then(|_| file.sync_all());
            let Err(source) = ended else {
                written.bytes = progress.bytes();
                return (written, Ok(()));
            };
            let error = write_error(&location.path, flushed.bytes, source);
            end_plainly(&file, &flushed);
            return (flushed, Err(error));
        }
        // The rest of the buffer must not be written.
        drop(buffer.into_parts());
        end_plainly(&file, &flushed);
        (flushed, finished)
    }

    /// The OS error is more useful than the error of the compressor that it causes.
    fn error(&self, source: mcap::McapError) -> Error {
        match self.progress.failure() {
            Some(failure) => write_error(&self.location.path, self.flushed.bytes, failure),
            None => Error::Write { path: self.location.path.clone(), source },
        }
    }
}

fn write_error(path: &Path, bytes: u64, source: io::Error) -> Error {
    match source.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            Error::NoSpace { path: path.to_path_buf(), bytes, source }
        }
        _ => Error::io("write", path)(source),
    }
}

/// Ends the file after the flushed data.
fn end_plainly(file: &File, flushed: &Written) {
    // If even this fails, the file is like that of a killed recorder, and can be read as such.
    let ended = file.set_len(flushed.bytes).and_then(|()| file.write_all_at(&plain_end(), flushed.bytes));
    if ended.is_err() {
        let _ = file.set_len(flushed.bytes);
    }
    let _ = file.sync_all();
}

/// The end of an MCAP file without an index: DataEnd without checksum, Footer without summary, magic. It fits on a full
/// disk.
fn plain_end() -> Vec<u8> {
    let record = |opcode: u8, length: u8| {
        let mut bytes = vec![opcode, length];
        bytes.resize(9 + usize::from(length), 0);
        bytes
    };
    [record(mcap::records::op::DATA_END, 4), record(mcap::records::op::FOOTER, 20), mcap::MAGIC.to_vec()].concat()
}
