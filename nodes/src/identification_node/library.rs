//! The models and bags that a goal may name: files below folders that the operator has set.

use std::fs::Metadata;
use std::io::Read;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Component, Path, PathBuf};

use excavator_model::Model;
use excavator_model::document::{DocumentError, built_in, parse};
use excavator_model::effects::Catalogue;
use nix::libc::O_NONBLOCK;

use super::printable::printable;
use super::refusals::tell_operator;

/// Largest model file, bytes. The largest built-in model has 11 kB.
const LARGEST_MODEL: u64 = 1 << 20;
/// Longest name of a file in a goal, bytes.
const LONGEST_NAME: usize = 1024;
/// Most entries of a bag's folder. rosbag2 writes one per split file and one of metadata.
const MOST_ENTRIES: usize = 10_000;
/// Most characters of a name or of a parser's excerpt that a message quotes.
pub(super) const QUOTED: usize = 300;

/// Why a goal's model or bag cannot be used, in one line. The text contains nothing read from a file. It is the same for a file
/// that does not exist, lies outside the folder or is not readable.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(super) enum Unusable {
    #[error("model \"{0}\" is neither built in nor a readable file below the node's model_folder")]
    Model(String),
    #[error("model \"{0}\" is not built in, and this node reads no files: it was started without model_folder")]
    NoModelFolder(String),
    #[error("bag \"{0}\" is not a readable bag below the node's bag_folder")]
    Bag(String),
    #[error("bag \"{0}\" cannot be read: this node reads no files, it was started without bag_folder")]
    NoBagFolder(String),
    #[error("model file \"{name}\" is not a model{place}; the node's console has the reason")]
    NotAModel { name: String, place: String },
    #[error("bag \"{0}\" is no readable recording of this machine; the node's console has the reason")]
    NotARecording(String),
    #[error("no bag is given; name at least one recording")]
    NoBags,
    #[error("{0}")]
    Text(String),
}

/// The folders, in canonical form; `None`: no files are offered.
#[derive(Debug, Clone, Default)]
pub(super) struct Library {
    models: Option<PathBuf>,
    bags: Option<PathBuf>,
}

impl Library {
    /// Opens the folders of the parameters `model_folder` and `bag_folder`; empty: no files are offered.
    ///
    /// # Errors
    /// The parameter that is not a folder, in one line.
    pub fn new(model_folder: &str, bag_folder: &str) -> Result<Self, String> {
        let folder = |parameter: &str, path: &str| {
            if path.is_empty() {
                return Ok(None);
            }
            let wrong = |reason: String| format!("{parameter} = {path} cannot be used: {reason}");
            let canonical = Path::new(path).canonicalize().map_err(|error| wrong(error.to_string()))?;
            if canonical.is_dir() { Ok(Some(canonical)) } else { Err(wrong("it is not a folder".to_string())) }
        };
        Ok(Library { models: folder("model_folder", model_folder)?, bags: folder("bag_folder", bag_folder)? })
    }

    /// The model that a goal names: its text, a built-in name, or the name of a file below `model_folder`.
    ///
    /// # Errors
    /// [`Unusable`].
    pub fn model(&self, given: &str) -> Result<Model, Unusable> {
        if given.contains('\n') {
            return parse("the model of the goal", given, &Catalogue::built_in())
                .map_err(|error| Unusable::Text(printable(&error.to_string(), QUOTED)));
        }
        if let Ok(model) = built_in(given) {
            return Ok(model);
        }
        let name = printable(given, QUOTED);
        let Some(root) = &self.models else { return Err(Unusable::NoModelFolder(name)) };
        let text = below(root, given).and_then(|path| text_of(&path)).ok_or(Unusable::Model(name.clone()))?;
        parse(given, &text, &Catalogue::built_in()).map_err(|error| {
            tell_operator(&error.to_string());
            Unusable::NotAModel { name, place: place(&error) }
        })
    }

    /// Text for the network, without the path of the bag folder.
    pub fn without_folder(&self, text: &str) -> String {
        let folder = self.bags.as_ref().map(|root| format!("{}/", root.display()));
        folder.map_or_else(|| text.to_string(), |folder| text.replace(&folder, ""))
    }

    /// The path of the bag that a goal names. `BAG@20..40` is a part of it.
    ///
    /// # Errors
    /// [`Unusable`].
    pub fn bag(&self, given: &str) -> Result<PathBuf, Unusable> {
        let name = printable(given, QUOTED);
        let Some(root) = &self.bags else { return Err(Unusable::NoBagFolder(name)) };
        if let Some(path) = bag_below(root, given) {
            return Ok(path);
        }
        let part = given.rsplit_once('@').and_then(|(before, part)| {
            let mut path = bag_below(root, before)?.into_os_string();
            path.push("@");
            path.push(part);
            Some(PathBuf::from(path))
        });
        part.ok_or(Unusable::Bag(name))
    }
}

/// The canonical path of `name`, if it is a relative name that stays below `root`. Names that could lead outside are rejected
/// before the file system is accessed, so that not even the response time reveals what exists there.
fn below(root: &Path, name: &str) -> Option<PathBuf> {
    let path = Path::new(name);
    let stays = path.components().all(|component| matches!(component, Component::Normal(_)));
    if name.is_empty() || name.len() > LONGEST_NAME || name.contains('\0') || !stays {
        return None;
    }
    let canonical = root.join(path).canonicalize().ok()?;
    (canonical != root && canonical.starts_with(root)).then_some(canonical)
}

/// A bag below `root`: a regular file, or a folder that contains only regular files below `root`. Readers open every file in a
/// folder, and a read of a pipe or a device might never end.
fn bag_below(root: &Path, name: &str) -> Option<PathBuf> {
    let path = below(root, name)?;
    let inside = |file: &Path| {
        let canonical = file.canonicalize().ok()?;
        (canonical.starts_with(root) && canonical.metadata().is_ok_and(|data| is_plain(&data))).then_some(())
    };
    if !path.is_dir() {
        inside(&path)?;
        // A map beside a bag is read together with it.
        let mut map = path.clone().into_os_string();
        map.push(".map.toml");
        let map = PathBuf::from(map);
        if map.symlink_metadata().is_ok() {
            inside(&map)?;
        }
        return Some(path);
    }
    for (count, entry) in path.read_dir().ok()?.enumerate() {
        let entry = entry.ok()?.path();
        if count >= MOST_ENTRIES {
            return None;
        }
        let is_folder = entry.symlink_metadata().ok()?.is_dir();
        if !is_folder {
            inside(&entry)?;
        }
    }
    Some(path)
}

fn is_plain(data: &Metadata) -> bool {
    data.is_file()
}

/// The text of a regular file of bounded size. Opening does not block, not even if a pipe has replaced the file since the
/// check.
fn text_of(path: &Path) -> Option<String> {
    let file = std::fs::OpenOptions::new().read(true).custom_flags(O_NONBLOCK).open(path).ok()?;
    let data = file.metadata().ok()?;
    if !is_plain(&data) || data.len() > LARGEST_MODEL {
        return None;
    }
    let mut text = String::new();
    file.take(LARGEST_MODEL).read_to_string(&mut text).ok()?;
    Some(text)
}

/// Line and column of a syntax error, without the message.
fn place(error: &DocumentError) -> String {
    let DocumentError::Syntax { reason, .. } = error else { return String::new() };
    let numbers = reason.strip_prefix("line ").and_then(|rest| {
        let (line, rest) = rest.split_once(", column ")?;
        let column: String = rest.chars().take_while(char::is_ascii_digit).collect();
        Some((line.parse::<u64>().ok()?, column.parse::<u64>().ok()?))
    });
    numbers.map_or(String::new(), |(line, column)| format!(" (line {line}, column {column})"))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::os::unix::fs::symlink;

    use nix::sys::stat::Mode;
    use nix::unistd::mkfifo;

    use super::*;

    /// An offered folder, and a secret file outside it.
    fn library() -> (tempfile::TempDir, Library) {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("offered");
        std::fs::create_dir(&root).unwrap();
        std::fs::write(folder.path().join("secret"), "root:x:0:0\n").unwrap();
        let root = root.to_str().unwrap();
        let library = Library::new(root, root).unwrap();
        (folder, library)
    }

    #[test]
    fn what_is_not_offered_is_refused_in_the_same_words_whether_it_exists_or_not() {
        let (folder, library) = library();
        let root = folder.path().join("offered");
        symlink(folder.path().join("secret"), root.join("link")).unwrap();
        symlink("/", root.join("out")).unwrap();
        mkfifo(&root.join("pipe"), Mode::S_IRWXU).unwrap();
        std::fs::create_dir(root.join("folder")).unwrap();
        std::fs::write(root.join("large"), vec![b'#'; (LARGEST_MODEL + 1) as usize]).unwrap();
        std::fs::write(root.join("binary"), [0xff, 0xfe]).unwrap();
        let absolute = folder.path().join("secret").display().to_string();
        let names =
            ["../secret", "link", "out/etc/passwd", "pipe", "folder", "large", "binary", "absent", "", ".", "a\0b"];
        for name in names.into_iter().chain([absolute.as_str(), "/dev/zero", "/proc/self/environ", "/etc/nothing"]) {
            let shown = printable(name, QUOTED);
            assert_eq!(library.model(name).err(), Some(Unusable::Model(shown.clone())), "{name}");
            if !["large", "binary", "folder"].contains(&name) {
                assert_eq!(library.bag(name).err(), Some(Unusable::Bag(shown)), "{name}");
            }
        }
    }

    #[test]
    fn a_bag_with_a_pipe_or_a_way_out_in_its_folder_is_refused() {
        let (folder, library) = library();
        let bag = folder.path().join("offered/bag");
        std::fs::create_dir(&bag).unwrap();
        std::fs::write(bag.join("bag_0.mcap"), "").unwrap();
        assert!(library.bag("bag").is_ok());
        assert!(library.bag("bag@1..2").unwrap().to_str().unwrap().ends_with("offered/bag@1..2"));
        symlink(folder.path().join("secret"), bag.join("metadata.yaml")).unwrap();
        assert!(library.bag("bag").is_err());
        std::fs::remove_file(bag.join("metadata.yaml")).unwrap();
        mkfifo(&bag.join("bag_1.mcap"), Mode::S_IRWXU).unwrap();
        assert!(library.bag("bag").is_err());
        assert!(library.bag("bag@1..2").is_err());
    }

    #[test]
    fn errors_have_the_place_but_no_text() {
        let (folder, library) = library();
        let text = "# a model\nroot:x:0:0:secret\n";
        std::fs::write(folder.path().join("offered/wrong.toml"), text).unwrap();
        let error = library.model("wrong.toml").unwrap_err().to_string();
        assert!(error.contains("line 2") && !error.contains("root"), "{error}");
        let error = library.model(text).unwrap_err().to_string();
        assert!(error.contains("line 2") && !error.contains("root"), "{error}");
    }

    #[test]
    fn without_folders_there_are_built_in_models_and_texts_only() {
        let library = Library::new("", "").unwrap();
        assert!(library.model("zx30u-arm").is_ok());
        let text = excavator_model::document::to_text(&built_in("zx30u-arm").unwrap()).unwrap();
        assert!(library.model(&text).is_ok());
        assert!(matches!(library.model("/etc/passwd"), Err(Unusable::NoModelFolder(_))));
        assert!(matches!(library.bag("bag"), Err(Unusable::NoBagFolder(_))));
        assert!(Library::new("/no/such/folder", "").is_err_and(|error| error.contains("model_folder")));
    }

    #[test]
    fn models_below_the_folder_are_read() {
        let (folder, library) = library();
        let text = excavator_model::document::to_text(&built_in("zx30u-arm").unwrap()).unwrap();
        std::fs::create_dir(folder.path().join("offered/pit")).unwrap();
        std::fs::write(folder.path().join("offered/pit/arm.toml"), text).unwrap();
        assert!(library.model("pit/arm.toml").is_ok());
    }
}
