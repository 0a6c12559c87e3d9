//! Makes a bag readable for other readers after its recorder was killed.
//!
//! A recorder that is killed leaves MCAP files without an end and a folder without `metadata.yaml`. This crate reads
//! such bags; `ros2 bag` and most other readers do not. Intact files are unchanged. The others are rewritten next to
//! the original, verified, and moved to its place atomically; then the metadata is written.

mod rewrite;
mod tally;

use std::path::{Path, PathBuf};

use crate::location::{BagFiles, from_folder};
use crate::metadata::{Contents, FILE_NAME, FileContents, Metadata, TopicContents};
use crate::qos::QosEntry;
use crate::regular_file::check_regular;
use crate::storage::{StorageFile, StorageKind};
use crate::{Damage, Error, Qos, ReadLimits};
use rewrite::rewrite;
use tally::Tally;

/// The result of reindexing a bag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reindexed {
    /// Each file, in the order of the bag.
    pub files: Vec<ReindexedFile>,
    /// The metadata that was written; `None` for a bare file.
    pub metadata: Option<PathBuf>,
    /// Number of topics.
    pub topics: usize,
}

/// The result of reindexing one file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReindexedFile {
    /// The file.
    pub path: PathBuf,
    /// Whether it was rewritten.
    pub rewritten: bool,
    /// Number of messages after reindexing.
    pub messages: u64,
    /// The damage in the original.
    pub damage: Vec<Damage>,
    /// Where the original was moved; `None` if it was replaced or is unchanged.
    pub original: Option<PathBuf>,
}

impl Reindexed {
    /// Messages of all files.
    #[must_use]
    pub fn messages(&self) -> u64 {
        self.files.iter().map(|file| file.messages).sum()
    }
}

/// Makes the bag at `path` readable for other readers: a folder with MCAP or SQLite3 files, or a bare MCAP file. With
/// `keep`, the original of a rewritten file is kept next to it as `NAME.damaged`.
///
/// # Errors
/// [`Error::NotABag`] for files of which nothing can be read, [`Error::StillWritten`], [`Error::NotVerified`],
/// [`Error::UnsupportedCompression`] for files that rosbag2 compressed as a whole; [`Error::Write`], [`Error::Io`].
/// On failure, every file is either unchanged or completely rewritten.
pub fn reindex(path: &Path, keep: bool) -> Result<Reindexed, Error> {
    let limits = ReadLimits::DEFAULT;
    if !path.exists() {
        return Err(Error::DoesNotExist { path: path.to_path_buf() });
    }
    let is_folder = path.is_dir();
    let files = if is_folder { files_of(path, &limits)? } else { bare(path)? };
    let mut bag = Tally::default();
    let mut done = Vec::new();
    let mut contents = Vec::new();
    let mut storage = None;
    for file in files {
        let (found, tally, kind) = one_file(&file, keep, &limits)?;
        if *storage.get_or_insert(kind) != kind {
            let reason = "it has MCAP and SQLite3 files; put them into two folders".to_string();
            return Err(Error::NotABag { path: path.to_path_buf(), reason });
        }
        contents.push(FileContents {
            name: file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            span: tally.span(),
            message_count: tally.messages(),
        });
        bag.add(&tally);
        done.push(found);
    }
    let topics = bag.topics();
    let count = topics.len();
    let metadata = if is_folder {
        Some(write_metadata(path, storage.unwrap_or(StorageKind::Mcap), &contents, topics)?)
    } else {
        None
    };
    Ok(Reindexed { files: done, metadata, topics: count })
}

/// The files listed in the metadata, otherwise all in the folder. Files that the metadata does not list are added: a
/// killed recorder may have started them.
fn files_of(folder: &Path, limits: &ReadLimits) -> Result<Vec<PathBuf>, Error> {
    let all = from_folder(folder)?.files;
    let mut listed = match BagFiles::locate(folder, limits) {
        Ok(found) => found.files,
        Err(_bad_or_missing_metadata) => Vec::new(),
    };
    let is_listed = |file: &PathBuf| listed.iter().any(|known| known.file_name() == file.file_name());
    let others: Vec<PathBuf> = all.into_iter().filter(|file| !is_listed(file)).collect();
    listed.extend(others);
    Ok(listed)
}

fn bare(path: &Path) -> Result<Vec<PathBuf>, Error> {
    check_regular(path)?;
    Ok(vec![path.to_path_buf()])
}

fn one_file(path: &Path, keep: bool, limits: &ReadLimits) -> Result<(ReindexedFile, Tally, StorageKind), Error> {
    let length = || std::fs::metadata(path).map(|metadata| metadata.len()).map_err(Error::io("read", path));
    let before = length()?;
    let mut file = StorageFile::open(path, limits)?;
    let Some(kind) = file.kind() else {
        let damage: Vec<String> = file.damage().map(ToString::to_string).collect();
        return Err(Error::NotABag { path: path.to_path_buf(), reason: damage.join("; ") });
    };
    if file.is_compressed() {
        let (mode, format) = ("file".to_string(), "zstd".to_string());
        return Err(Error::UnsupportedCompression { path: path.to_path_buf(), mode, format });
    }
    let mut tally = Tally::default();
    tally.define(file.topics().into_iter());
    while let Some(message) = file.next_message()? {
        tally.count(&message);
    }
    tally.define(file.topics().into_iter());
    let damage: Vec<Damage> = file.damage().cloned().collect();
    if length()? != before {
        return Err(Error::StillWritten { path: path.to_path_buf() });
    }
    let whole = damage.is_empty() && file.has_index();
    let mut found = ReindexedFile {
        path: path.to_path_buf(),
        rewritten: false,
        messages: tally.messages(),
        damage,
        original: None,
    };
    // The index of SQLite is part of the database and cannot be missing; damage in it is not repaired.
    if !whole && kind == StorageKind::Mcap {
        drop(file);
        found.original = rewrite(path, &tally, before, keep, limits)?;
        found.rewritten = true;
    }
    Ok((found, tally, kind))
}

fn write_metadata(
    folder: &Path,
    storage: StorageKind,
    files: &[FileContents],
    topics: Vec<(std::sync::Arc<crate::Topic>, u64)>,
) -> Result<PathBuf, Error> {
    let path = folder.join(FILE_NAME);
    // Custom data that a user added to the metadata is kept.
    let custom_data = Metadata::custom_data(&path, &ReadLimits::DEFAULT);
    let topics: Vec<TopicContents> = topics
        .into_iter()
        .map(|(topic, message_count)| {
            let qos: Vec<QosEntry> = Qos::entries(&topic.qos());
            TopicContents { name: topic.name.clone(), type_name: topic.type_name.clone(), qos, message_count }
        })
        .collect();
    let contents = Contents { storage: storage.name(), files, topics: &topics, custom_data: &custom_data };
    let failed = Error::io("write", &path);
    let text = match contents.to_yaml() {
        Ok(text) => text,
        Err(reason) => return Err(failed(std::io::Error::other(reason))),
    };
    let written = tempfile::NamedTempFile::new_in(folder).and_then(|mut file| {
        std::io::Write::write_all(&mut file, text.as_bytes())?;
        rewrite::with_usual_rights(file.as_file())?;
        file.as_file().sync_all()?;
        file.persist(&path).map_err(|error| error.error)
    });
    written.map_err(failed)?;
    Ok(path)
}
