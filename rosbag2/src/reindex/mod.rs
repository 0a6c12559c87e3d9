//! Makes a bag readable for other readers after its recorder was killed.
//!
//! A recorder that is killed leaves MCAP files without an end and a folder without `metadata.yaml`. This crate reads
//! such bags; `ros2 bag` and most other readers do not. Intact files are unchanged. The others are rewritten next to
//! the original, verified, and moved to its place atomically; then the metadata is written, and the whole bag read back.
//!
//! A bag that rosbag2 compressed stays compressed, and its metadata says so. A killed recorder may have left its last file
//! uncompressed beside compressed ones, which no metadata can describe: that file is compressed too.

mod readable;
mod rewrite;
mod tally;

use std::path::{Path, PathBuf};

use crate::location::{BagFiles, from_folder};
use crate::metadata::{BagCompression, Contents, FILE_NAME, FileContents, Metadata, TopicContents};
use crate::qos::QosEntry;
use crate::regular_file::check_regular;
use crate::storage::StorageKind;
use crate::{Damage, Error, Qos, RawMessages, ReadLimits};
use readable::Readable;
use rewrite::{Original, rewrite};
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
    /// What rosbag2 compressed.
    pub compression: BagCompression,
}

/// The result of reindexing one file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReindexedFile {
    /// The file.
    pub path: PathBuf,
    /// Whether it was rewritten.
    pub rewritten: bool,
    /// Whether it was compressed as a whole, as the other files of the bag are.
    pub packed: bool,
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
/// [`Error::NotReadBack`], [`Error::MixedCompression`]; [`Error::Write`], [`Error::Io`].
/// On failure, every file is either unchanged or completely rewritten.
pub fn reindex(path: &Path, keep: bool) -> Result<Reindexed, Error> {
    let limits = ReadLimits::DEFAULT;
    if !path.exists() {
        return Err(Error::DoesNotExist { path: path.to_path_buf() });
    }
    let is_folder = path.is_dir();
    let files = if is_folder { files_of(path, &limits)? } else { bare(path)? };
    let mut read = Vec::new();
    for file in &files {
        read.push(one_file(file, keep, &limits)?);
    }
    let compression = compression(path, &read)?;
    let mut bag = Tally::default();
    let mut contents = Vec::new();
    for one in &mut read {
        if compression == BagCompression::File && !one.is_packed {
            pack(one, keep, &limits)?;
        }
        let name = one.found.path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        contents.push(FileContents { name, span: one.tally.span(), message_count: one.tally.messages() });
        bag.add(&one.tally);
    }
    let storage = read.first().map_or(StorageKind::Mcap, |one| one.kind);
    let topics = bag.topics();
    let count = topics.len();
    let metadata = match is_folder {
        true => Some(write_metadata(path, storage, &contents, topics, compression)?),
        false => None,
    };
    let found: Vec<ReindexedFile> = read.into_iter().map(|one| one.found).collect();
    let written = match &found[..] {
        // A bare file may have a new name.
        [only] if !is_folder => only.path.clone(),
        _ => path.to_path_buf(),
    };
    read_back(&written, bag.messages(), &limits)?;
    Ok(Reindexed { files: found, metadata, topics: count, compression })
}

/// What rosbag2 compressed in these files.
fn compression(bag: &Path, files: &[OneFile]) -> Result<BagCompression, Error> {
    if files.iter().any(|one| one.kind != files[0].kind) {
        let reason = "it has MCAP and SQLite3 files; put them into two folders".to_string();
        return Err(Error::NotABag { path: bag.to_path_buf(), reason });
    }
    let sum = |of: &dyn Fn(&OneFile) -> u64| files.iter().map(of).sum::<u64>();
    let (messages, compressed) = (sum(&|one| one.tally.messages()), sum(&|one| one.tally.compressed()));
    let is_packed = files.iter().any(|one| one.is_packed);
    if compressed > 0 && (compressed < messages || is_packed) {
        return Err(Error::MixedCompression { path: bag.to_path_buf(), compressed, messages });
    }
    Ok(match (is_packed, compressed > 0) {
        (true, _) => BagCompression::File,
        (false, true) => BagCompression::Message,
        (false, false) => BagCompression::None,
    })
}

/// Reads the bag as any reader does, and counts its messages.
fn read_back(bag: &Path, expected: u64, limits: &ReadLimits) -> Result<(), Error> {
    let mut found = 0;
    for message in RawMessages::open_within(bag, limits)? {
        message?;
        found += 1;
    }
    if found == expected { Ok(()) } else { Err(Error::NotReadBack { path: bag.to_path_buf(), found, expected }) }
}

/// Compresses a file as a whole: `NAME.zstd`.
fn pack(one: &mut OneFile, keep: bool, limits: &ReadLimits) -> Result<(), Error> {
    let path = one.found.path.clone();
    let mut name = path.clone().into_os_string();
    name.push(".zstd");
    let target = PathBuf::from(name);
    let length = std::fs::metadata(&path).map_err(Error::io("read", &path))?.len();
    // The original of a file that was rewritten is kept already.
    let keep = keep && one.found.original.is_none();
    let original = Original { path: &path, tally: &one.tally, length, packs: true, keep };
    let kept = rewrite(&original, &target, limits)?;
    one.found.original = one.found.original.take().or(kept);
    (one.found.path, one.found.packed) = (target, true);
    Ok(())
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

/// One file and what was read of it.
struct OneFile {
    found: ReindexedFile,
    tally: Tally,
    kind: StorageKind,
    /// Whether rosbag2 compressed the whole file.
    is_packed: bool,
}

fn one_file(path: &Path, keep: bool, limits: &ReadLimits) -> Result<OneFile, Error> {
    let length = || std::fs::metadata(path).map(|metadata| metadata.len()).map_err(Error::io("read", path));
    let before = length()?;
    let mut source = Readable::open(path, limits)?;
    let Some(kind) = source.file().kind() else {
        let damage: Vec<String> = source.damage().iter().map(ToString::to_string).collect();
        return Err(Error::NotABag { path: path.to_path_buf(), reason: damage.join("; ") });
    };
    let is_packed = source.file().is_compressed();
    let tally = Tally::of(&mut source)?;
    let damage = source.damage();
    if length()? != before {
        return Err(Error::StillWritten { path: path.to_path_buf() });
    }
    let whole = damage.is_empty() && source.file().has_index();
    let messages = tally.messages();
    let mut found =
        ReindexedFile { path: path.to_path_buf(), rewritten: false, packed: false, messages, damage, original: None };
    // The index of SQLite is part of the database and cannot be missing; damage in it is not repaired.
    if !whole && kind == StorageKind::Mcap {
        drop(source);
        let original = Original { path, tally: &tally, length: before, packs: is_packed, keep };
        found.original = rewrite(&original, path, limits)?;
        found.rewritten = true;
    }
    Ok(OneFile { found, tally, kind, is_packed })
}

fn write_metadata(
    folder: &Path,
    storage: StorageKind,
    files: &[FileContents],
    topics: Vec<(std::sync::Arc<crate::Topic>, u64)>,
    compression: BagCompression,
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
    let (storage, custom_data) = (storage.name(), &custom_data);
    let contents = Contents { storage, files, topics: &topics, custom_data, compression };
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
