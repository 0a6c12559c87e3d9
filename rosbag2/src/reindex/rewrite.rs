//! Rewrites a damaged MCAP file.

use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mcap::records::MessageHeader;

use super::readable::Readable;
use super::tally::Tally;
use crate::{Error, ReadLimits, Topic, WriteOptions};

/// A file of a bag that is written anew.
pub(super) struct Original<'o> {
    pub path: &'o Path,
    /// What can be read of it.
    pub tally: &'o Tally,
    /// Its length when it was read, bytes.
    pub length: u64,
    /// Whether the new file is compressed as a whole.
    pub packs: bool,
    /// Whether the original is kept.
    pub keep: bool,
}

/// Writes the readable messages of a file to a new one, verifies it, and moves it to `target`: the place of the original, or
/// beside it. Returns the new path of the original, if it was kept.
pub(super) fn rewrite(original: &Original, target: &Path, limits: &ReadLimits) -> Result<Option<PathBuf>, Error> {
    let path = original.path;
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut new = beside(folder)?;
    let is_rewritten = path == target;
    if is_rewritten {
        copy(path, new.reopen().map_err(Error::io("write", new.path()))?, limits)?;
    }
    if original.packs {
        let packed = beside(folder)?;
        pack(if is_rewritten { new.path() } else { path }, &packed)?;
        new = packed;
    }
    if read_back(new.path(), limits)?.fingerprint() != original.tally.fingerprint() {
        return Err(Error::NotVerified { path: path.to_path_buf() });
    }
    let now = std::fs::metadata(path).map_err(Error::io("read", path))?.len();
    if now != original.length {
        return Err(Error::StillWritten { path: path.to_path_buf() });
    }
    with_usual_rights(new.as_file()).map_err(Error::io("write", new.path()))?;
    let kept = original.keep.then(|| {
        let mut name = path.as_os_str().to_os_string();
        name.push(".damaged");
        PathBuf::from(name)
    });
    if let Some(kept) = &kept {
        // A hard link to the same bytes, so that the bag file exists at all times.
        std::fs::hard_link(path, kept).map_err(Error::io("keep the original as", kept))?;
    }
    new.persist(target).map_err(|error| Error::io("replace", path)(error.error))?;
    if !is_rewritten {
        std::fs::remove_file(path).map_err(Error::io("remove", path))?;
    }
    // The rename survives a power cut only after the folder is synced to disk.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    Ok(kept)
}

/// A file with a name that no reader of the folder takes for a file of the bag; it is removed on any failure.
fn beside(folder: &Path) -> Result<tempfile::NamedTempFile, Error> {
    tempfile::Builder::new().prefix(".reindex-").tempfile_in(folder).map_err(Error::io("create a file in", folder))
}

/// Compresses a whole file as rosbag2 does.
fn pack(path: &Path, packed: &tempfile::NamedTempFile) -> Result<(), Error> {
    let source = File::open(path).map_err(Error::io("read", path))?;
    let target = packed.reopen().map_err(Error::io("write", packed.path()))?;
    zstd::stream::copy_encode(io::BufReader::new(source), &target, zstd::DEFAULT_COMPRESSION_LEVEL)
        .and_then(|()| target.sync_all())
        .map_err(Error::io("write", packed.path()))
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
    let mut source = Readable::open(path, limits)?;
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
    for topic in source.file().topics() {
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
    let mut source = Readable::open(path, limits)?;
    let tally = Tally::of(&mut source)?;
    if !source.damage().is_empty() || !source.file().has_index() {
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
