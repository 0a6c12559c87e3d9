//! From a path to the MCAP files of a bag, in reading order.

use std::path::{Path, PathBuf};

use crate::BagError;
use crate::metadata::{FILE_NAME, Metadata, TopicMetadata};

/// The first bytes of every SQLite database.
const SQLITE_MAGIC: &[u8] = b"SQLite format 3\0";

/// The files of one bag.
#[derive(Debug)]
pub(crate) struct BagFiles {
    /// The MCAP files: in the order of the metadata, or by name without metadata.
    pub files: Vec<PathBuf>,
    /// How many messages `metadata.yaml` promises.
    pub promised_messages: Option<u64>,
}

impl BagFiles {
    /// Finds the files of the bag at `path` and refuses what cannot be read, before anything is read.
    pub fn locate(path: &Path) -> Result<BagFiles, BagError> {
        if !path.exists() {
            return Err(BagError::DoesNotExist { path: path.to_path_buf() });
        }
        if !path.is_dir() {
            refuse_sqlite(path)?;
            return Ok(BagFiles { files: vec![path.to_path_buf()], promised_messages: None });
        }
        let metadata_path = path.join(FILE_NAME);
        if metadata_path.exists() { from_metadata(path, &metadata_path) } else { from_folder(path) }
    }
}

fn from_metadata(folder: &Path, metadata_path: &Path) -> Result<BagFiles, BagError> {
    let metadata = Metadata::read(metadata_path)?;
    if metadata.storage_identifier != "mcap" {
        let storage = match metadata.storage_identifier.as_str() {
            "sqlite3" => "SQLite3".to_string(),
            other => format!("\"{other}\""),
        };
        return Err(BagError::UnsupportedStorage { path: folder.to_path_buf(), storage });
    }
    if let Some(mode) = metadata.compression_mode.filter(|mode| !mode.is_empty() && !mode.eq_ignore_ascii_case("none"))
    {
        let format = metadata.compression_format.unwrap_or_default();
        return Err(BagError::UnsupportedCompression { path: folder.to_path_buf(), mode, format });
    }
    for topic in metadata.topics_with_message_count {
        let TopicMetadata { name, serialization_format } = topic.topic_metadata;
        if serialization_format != "cdr" {
            return Err(BagError::UnsupportedSerialization {
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
                .ok_or_else(|| BagError::MissingFile { metadata: metadata_path.to_path_buf(), file: listed.clone() })?,
        );
    }
    Ok(BagFiles { files, promised_messages: metadata.message_count })
}

/// The listed file. Early versions of rosbag2 wrote the path with the folder's name in front, and folders get renamed:
/// so the bare file name counts too.
fn beside(folder: &Path, listed: &str) -> Option<PathBuf> {
    let as_written = folder.join(listed);
    let by_name = Path::new(listed).file_name().map(|name| folder.join(name));
    [Some(as_written), by_name].into_iter().flatten().find(|path| path.is_file())
}

fn from_folder(folder: &Path) -> Result<BagFiles, BagError> {
    let mut files = Vec::new();
    let mut has_sqlite = false;
    for entry in std::fs::read_dir(folder).map_err(BagError::io("read", folder))? {
        let path = entry.map_err(BagError::io("read", folder))?.path();
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("mcap") if path.is_file() => files.push(path),
            Some("db3") => has_sqlite = true,
            _ => {}
        }
    }
    if files.is_empty() {
        return Err(if has_sqlite {
            BagError::UnsupportedStorage { path: folder.to_path_buf(), storage: "SQLite3".to_string() }
        } else {
            BagError::NotABag {
                path: folder.to_path_buf(),
                reason: "the folder has neither metadata.yaml nor an .mcap file".to_string(),
            }
        });
    }
    files.sort_by_key(|path| natural_order(path));
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

fn refuse_sqlite(path: &Path) -> Result<(), BagError> {
    use std::io::Read;
    let mut start = Vec::new();
    let file = std::fs::File::open(path).map_err(BagError::io("open", path))?;
    file.take(SQLITE_MAGIC.len() as u64).read_to_end(&mut start).map_err(BagError::io("read", path))?;
    let is_sqlite = start == SQLITE_MAGIC || path.extension().is_some_and(|extension| extension == "db3");
    if is_sqlite {
        return Err(BagError::UnsupportedStorage { path: path.to_path_buf(), storage: "SQLite3".to_string() });
    }
    Ok(())
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
