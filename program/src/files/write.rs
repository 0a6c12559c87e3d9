//! Writes an output completely or not at all.

use std::fs::{File, OpenOptions, Permissions};
use std::io::{ErrorKind, IsTerminal, Write};
use std::os::unix::fs::{FileTypeExt, PermissionsExt};
use std::path::Path;

use super::place::{Place, folder_of, is_open_file};
use crate::cli::Overwriting;
use crate::error::VerbError;
use crate::terminal;

/// Mode of a new file before the umask.
const NEW_FILE: u32 = 0o666;

/// Writes a text. The file gets its name only when it is complete and on the disk. An existing file is replaced only with
/// `--force`. If a file has appeared since the check, the result is kept in another file.
///
/// # Errors
/// [`VerbError::Write`], [`VerbError::Link`], [`VerbError::Exists`], [`VerbError::Appeared`].
pub fn write(path: &Path, text: &str, overwriting: Overwriting) -> Result<(), VerbError> {
    if path == Path::new("-") {
        return standard_output(text);
    }
    let permissions = match Place::of(path)? {
        Place::Stream => return write_stream(path, text).map_err(VerbError::write(path)),
        Place::File(_) if overwriting.force => path.metadata().map_err(VerbError::write(path))?.permissions(),
        Place::File(_) | Place::Free => Permissions::from_mode(NEW_FILE),
    };
    let folder = folder_of(path);
    let complete = || {
        let mut file = tempfile::Builder::new()
            .prefix(".excavator-")
            .permissions(Permissions::from_mode(NEW_FILE))
            .tempfile_in(folder)?;
        file.write_all(text.as_bytes())?;
        if overwriting.force && permissions.mode() != NEW_FILE {
            file.as_file().set_permissions(permissions)?;
        }
        file.as_file().sync_all()?;
        Ok(file)
    };
    let file: tempfile::NamedTempFile = complete().map_err(VerbError::write(path))?;
    // A rename replaces a link instead of following it. The check above protects users who meant the link's target.
    let placed = if overwriting.force { file.persist(path) } else { file.persist_noclobber(path) };
    match placed {
        Ok(_) => {
            // Syncing the folder makes the rename durable. Not every file system supports it, and the file is already complete.
            let _ = File::open(folder).and_then(|folder| folder.sync_all());
            terminal::remark(&format!("written: {}", path.display()));
            Ok(())
        }
        Err(failed) if failed.error.kind() == ErrorKind::AlreadyExists => match failed.file.keep() {
            Ok((_, kept)) => Err(VerbError::Appeared { path: path.to_path_buf(), kept }),
            Err(_) => Err(VerbError::Exists { path: path.to_path_buf() }),
        },
        Err(failed) => Err(VerbError::write(path)(failed.error)),
    }
}

/// Writes to a pipe or a character device. A link in `/dev` may lead to a file that the shell has opened for us.
fn write_stream(path: &Path, text: &str) -> std::io::Result<()> {
    let mut stream = OpenOptions::new().append(true).open(path)?;
    let kind = stream.metadata()?.file_type();
    // Nothing has been written yet if the path has changed in the meantime.
    if !(kind.is_fifo() || kind.is_char_device() || is_open_file(path)) {
        return Err(std::io::Error::other("it has changed meanwhile"));
    }
    match stream.write_all(text.as_bytes()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written,
    }
}

/// Writes a document to standard output. Its text is escaped only if that is a terminal.
///
/// # Errors
/// [`VerbError::NotPrinted`]. A closed pipe is not an error.
pub fn standard_output(text: &str) -> Result<(), VerbError> {
    let mut output = std::io::stdout();
    let shown = if output.is_terminal() { terminal::text(text) } else { text.into() };
    match output.write_all(shown.as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(VerbError::NotPrinted(error.to_string())),
        _ => Ok(()),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const FORCE: Overwriting = Overwriting { force: true };
    const CAREFUL: Overwriting = Overwriting { force: false };

    #[test]
    fn only_force_replaces_and_keeps_the_mode() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.toml");
        write(&path, "first", CAREFUL).unwrap();
        assert_eq!(path.metadata().unwrap().permissions().mode() & 0o600, 0o600);
        std::fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        let error = write(&path, "second", CAREFUL).unwrap_err();
        let VerbError::Appeared { kept, .. } = error else { unreachable!("{error}") };
        assert_eq!(std::fs::read_to_string(kept).unwrap(), "second");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "first");
        write(&path, "third", FORCE).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "third");
        assert_eq!(path.metadata().unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[test]
    fn links_are_not_followed_and_streams_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        std::fs::write(&target, "text").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        for overwriting in [FORCE, CAREFUL] {
            assert!(matches!(write(&link, "other", overwriting), Err(VerbError::Link { .. })));
        }
        assert_eq!(std::fs::read_to_string(&target).unwrap(), "text");
        write(Path::new("/dev/null"), "text", CAREFUL).unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || std::fs::read_to_string(pipe).unwrap()
        });
        write(&pipe, "through", CAREFUL).unwrap();
        assert_eq!(reader.join().unwrap(), "through");
    }
}
