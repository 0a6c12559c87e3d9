//! Finds the files of a bag from a path, in reading order.

use std::path::{Path, PathBuf};

use crate::Error;
use crate::limits::{Limit, ReadLimits};
use crate::metadata::{FILE_NAME, Metadata, TopicMetadata};
use crate::regular_file::{check_regular, open_regular};

/// The first bytes of every SQLite database.
pub(crate) const SQLITE_MAGIC: &[u8] = b"SQLite format 3\0";
/// File extensions of bags, also when compressed as a whole.
const EXTENSIONS: [&str; 4] = [".mcap", ".db3", ".mcap.zstd", ".db3.zstd"];

/// The files of one bag.
#[derive(Debug)]
pub(crate) struct BagFiles {
    /// MCAP or SQLite3 files: in the order of the metadata, or by name without metadata.
    pub files: Vec<PathBuf>,
    /// Number of messages that `metadata.yaml` declares.
    pub promised_messages: Option<u64>,
}

impl BagFiles {
    /// Finds the files of the bag at `path` and rejects unsupported formats before reading any data.
    pub fn locate(path: &Path, limits: &ReadLimits) -> Result<BagFiles, Error> {
        if !path.exists() {
            return Err(Error::DoesNotExist { path: path.to_path_buf() });
        }
        if !path.is_dir() {
            check_regular(path)?;
            return Ok(BagFiles { files: vec![path.to_path_buf()], promised_messages: None });
        }
        let metadata_path = path.join(FILE_NAME);
        let found =
            if metadata_path.exists() { from_metadata(path, &metadata_path, limits) } else { from_folder(path) }?;
        Limit::Files
            .check(found.files.len() as u64, limits.files as u64)
            .map_err(|source| Error::Limit { path: path.to_path_buf(), source })?;
        Ok(found)
    }
}

fn from_metadata(folder: &Path, metadata_path: &Path, limits: &ReadLimits) -> Result<BagFiles, Error> {
    let metadata = Metadata::read(metadata_path, limits)?;
    if !["mcap", "sqlite3"].contains(&metadata.storage_identifier.as_str()) {
        let storage = format!("\"{}\"", metadata.storage_identifier);
        return Err(Error::UnsupportedStorage { path: folder.to_path_buf(), storage });
    }
    // Compressed data is recognised by its magic bytes; the metadata is only used to reject formats other than zstd.
    if let Some(mode) = metadata.compression_mode.filter(|mode| !mode.is_empty() && !mode.eq_ignore_ascii_case("none"))
    {
        let format = metadata.compression_format.unwrap_or_default();
        if !format.eq_ignore_ascii_case("zstd") {
            return Err(Error::UnsupportedCompression { path: folder.to_path_buf(), mode, format });
        }
    }
    for topic in metadata.topics_with_message_count {
        let TopicMetadata { name, serialization_format } = topic.topic_metadata;
        if serialization_format != "cdr" {
            return Err(Error::UnsupportedSerialization {
                path: folder.to_path_buf(),
                topic: name,
                format: serialization_format,
            });
        }
    }
    let mut files = Vec::new();
    for listed in metadata.relative_file_paths {
        files.push(
            beside(folder, &listed)
                .ok_or_else(|| Error::MissingFile { metadata: metadata_path.to_path_buf(), file: listed.clone() })?,
        );
    }
    Ok(BagFiles { files, promised_messages: metadata.message_count })
}

/// The listed file. Early versions of rosbag2 wrote the path with the folder name in front, and folders get renamed: so
/// the bare file name is accepted too. Compressed files may be listed or stored with or without their last extension.
fn beside(folder: &Path, listed: &str) -> Option<PathBuf> {
    let as_written = folder.join(listed);
    let by_name = folder.join(Path::new(listed).file_name()?);
    let mut packed = by_name.clone().into_os_string();
    packed.push(".zstd");
    let unpacked = by_name.with_extension("");
    let is_packed = by_name.extension().is_some_and(|extension| extension == "zstd");
    let others = if is_packed { unpacked } else { PathBuf::from(packed) };
    [as_written, by_name, others].into_iter().find(|path| path.is_file())
}

/// The files of a bag in a folder, regardless of its metadata.
pub(crate) fn from_folder(folder: &Path) -> Result<BagFiles, Error> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(Error::io("read", folder))? {
        let path = entry.map_err(Error::io("read", folder))?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
        if EXTENSIONS.iter().any(|extension| name.ends_with(extension)) && path.is_file() {
            files.push(path);
        }
    }
    if files.is_empty() {
        return Err(Error::NotABag {
            path: folder.to_path_buf(),
            reason: "the folder has neither metadata.yaml nor an .mcap or .db3 file".to_string(),
        });
    }
    files.sort_by_key(|path| natural_order(path));
    // A compressed file next to its uncompressed original contains the same data.
    let plain: Vec<PathBuf> = files.clone();
    files.retain(|path| path.extension().is_none_or(|end| end != "zstd") || !plain.contains(&path.with_extension("")));
    Ok(BagFiles { files, promised_messages: None })
}

/// Sorts `bag_2.mcap` before `bag_10.mcap`: by name, with runs of digits compared as numbers.
fn natural_order(path: &Path) -> Vec<(String, u64)> {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut parts: Vec<(String, u64)> = Vec::new();
    let mut in_number = true;
    for character in name.chars() {
        match (character.to_digit(10), parts.last_mut()) {
            (Some(digit), Some((_, number))) => {
                *number = number.saturating_mul(10).saturating_add(u64::from(digit));
                in_number = true;
            }
            (Some(digit), None) => parts.push((String::new(), u64::from(digit))),
            (None, Some((text, _))) if !in_number => text.push(character),
            (None, _) => {
                parts.push((character.to_string(), 0));
                in_number = false;
            }
        }
    }
    parts
}

/// The first bytes of a file, as many as needed to detect its format.
pub(crate) fn first_bytes(path: &Path) -> Result<Vec<u8>, Error> {
    use std::io::Read;
    let mut start = Vec::new();
    let (file, _) = open_regular(path)?;
    file.take(SQLITE_MAGIC.len() as u64).read_to_end(&mut start).map_err(Error::io("read", path))?;
    Ok(start)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn split_files_sort_by_number() {
        let mut names = ["bag_10.mcap", "bag_9.mcap", "bag_0.mcap", "a_11.mcap"].map(PathBuf::from);
        names.sort_by_key(|path| natural_order(path));
        assert_eq!(names, ["a_11.mcap", "bag_0.mcap", "bag_9.mcap", "bag_10.mcap"].map(PathBuf::from));
    }
}
