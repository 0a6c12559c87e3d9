//! Rewrites a damaged MCAP file.

use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mcap::records::MessageHeader;

use super::tally::Tally;
use crate::storage::StorageFile;
use crate::{Error, ReadLimits, Topic, WriteOptions};

/// Writes the readable messages of the file at `path` to a new file, verifies it against `tally`, and replaces the
/// original. Returns the new path of the original, if it was kept.
pub(super) fn rewrite(
    path: &Path,
    tally: &Tally,
    length: u64,
    keep: bool,
    limits: &ReadLimits,
) -> Result<Option<PathBuf>, Error> {
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // A name that no reader of the folder takes for a file of the bag; the file is removed on any failure.
    let beside = tempfile::Builder::new()
        .prefix(".reindex-")
        .tempfile_in(folder)
        .map_err(Error::io("create a file in", folder))?;
    let file = beside.reopen().map_err(Error::io("write", beside.path()))?;
    copy(path, file, limits)?;
    let copied = read_back(beside.path(), limits)?;
    if copied.fingerprint() != tally.fingerprint() {
        return Err(Error::NotVerified { path: path.to_path_buf() });
    }
    let now = std::fs::metadata(path).map_err(Error::io("read", path))?.len();
    if now != length {
        return Err(Error::StillWritten { path: path.to_path_buf() });
    }
    with_usual_rights(beside.as_file()).map_err(Error::io("write", beside.path()))?;
    let original = keep.then(|| {
        let mut name = path.as_os_str().to_os_string();
        name.push(".damaged");
        PathBuf::from(name)
    });
    if let Some(original) = &original {
        // A hard link to the same bytes, so that the bag file exists at all times.
        std::fs::hard_link(path, original).map_err(Error::io("keep the original as", original))?;
    }
    beside.persist(path).map_err(|error| Error::io("replace", path)(error.error))?;
    // The rename survives a power cut only after the folder is synced to disk.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    Ok(original)
}

fn copy(path: &Path, file: File, limits: &ReadLimits) -> Result<(), Error> {
    let failed = |source| Error::Write { path: path.to_path_buf(), source };
    let options = WriteOptions::default();
    let mut writer = mcap::WriteOptions::new()
        .profile("ros2")
        .library(concat!("excavator ", env!("CARGO_PKG_VERSION")))
        .compression(options.compression.to_mcap())
        .compression_threads(0)
        .chunk_size(Some(options.chunk_size))
        .create(BufWriter::new(file))
        .map_err(failed)?;
    let mut source = StorageFile::open(path, limits)?;
    let mut channels: HashMap<String, u16> = HashMap::new();
    while let Some(message) = source.next_message()? {
        let channel_id = match channels.get(&message.topic.name) {
            Some(&known) => known,
            None => {
                let added = add(&mut writer, &message.topic).map_err(failed)?;
                channels.insert(message.topic.name.clone(), added);
                added
            }
        };
        let header = MessageHeader {
            channel_id,
            sequence: message.sequence,
            log_time: message.log_time,
            publish_time: message.publish_time,
        };
        writer.write_to_known_channel(&header, &message.data).map_err(failed)?;
    }
    // Topics without messages belong to the bag as well.
    for topic in source.topics() {
        if !channels.contains_key(&topic.name) {
            let added = add(&mut writer, topic).map_err(failed)?;
            channels.insert(topic.name.clone(), added);
        }
    }
    writer.finish().map_err(failed)?;
    writer
        .into_inner()
        .into_inner()
        .map_err(io::IntoInnerError::into_error)
        .and_then(|file| file.sync_all())
        .map_err(Error::io("write the new", path))
}

fn add<W: io::Write + io::Seek>(writer: &mut mcap::Writer<W>, topic: &Arc<Topic>) -> mcap::McapResult<u16> {
    let schema = writer.add_schema(&topic.type_name, &topic.schema_encoding, topic.schema.as_bytes())?;
    let metadata = BTreeMap::from([("offered_qos_profiles".to_string(), topic.offered_qos_profiles.clone())]);
    writer.add_channel(schema, &topic.name, &topic.message_encoding, &metadata)
}

/// The contents of the new file; empty if it is not intact.
fn read_back(path: &Path, limits: &ReadLimits) -> Result<Tally, Error> {
    let mut file = StorageFile::open(path, limits)?;
    let mut tally = Tally::default();
    tally.define(file.topics().into_iter());
    while let Some(message) = file.next_message()? {
        tally.count(&message);
    }
    if file.damage().next().is_some() || !file.has_index() {
        return Ok(Tally::default());
    }
    Ok(tally)
}

/// Temporary files are readable only by their user; a bag file has the usual permissions.
pub(super) fn with_usual_rights(file: &File) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        file.set_permissions(std::fs::Permissions::from_mode(0o644))?;
    }
    let _ = file;
    Ok(())
}
