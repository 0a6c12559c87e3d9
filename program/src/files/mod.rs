//! What is written: the output files of a verb.
//!
//! [`check`] and [`check_bag`] check them before the verb computes, so that a minute of work does not end at a folder that does
//! not exist. [`write`] checks again and writes to a temporary file beside the target. The complete file is then renamed to the
//! target.
//!
//! An existing file is replaced only with `--force`. A file that the same command reads, or writes under another option, is
//! never replaced. If the last component of a path is a symbolic link, it is never followed. Pipes, character devices and `-`
//! (standard output) are written directly.

mod inputs;
mod place;
mod results;
mod write;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

pub use inputs::Inputs;
pub use results::{finite, write_json, write_page, write_told};
pub use write::{standard_output, write};

use crate::cli::Overwriting;
use crate::error::VerbError;
use place::{FileId, Place, folder_of};

/// The outputs of a verb, each with the option that names it.
pub type Outputs<'a> = [(&'static str, Option<&'a Path>)];

/// Checks that every output can be written, and that none replaces an input, another output or, without `--force`, an existing
/// file.
///
/// # Errors
/// [`VerbError::Write`], [`VerbError::Link`], [`VerbError::SameFile`], [`VerbError::Exists`].
pub fn check(outputs: &Outputs, inputs: &Inputs, overwriting: Overwriting) -> Result<(), VerbError> {
    let mut earlier: Vec<(&str, (PathBuf, OsString), Option<FileId>)> = Vec::new();
    for (option, path) in outputs.iter().filter_map(|(option, path)| Some((*option, (*path)?))) {
        let id = match Place::of(path)? {
            Place::Stream => continue,
            Place::File(id) => Some(id),
            Place::Free => None,
        };
        let same = |what: String| VerbError::SameFile { option, path: path.to_path_buf(), what };
        if id.is_some_and(|id| inputs.has(id)) {
            return Err(same("it is read by this command".into()));
        }
        let name = full_name(path)?;
        let is_same = |(_, other, other_id): &&(&str, _, _)| *other == name || (id.is_some() && *other_id == id);
        if let Some((other, ..)) = earlier.iter().find(is_same) {
            return Err(same(format!("{other} is the same file")));
        }
        if id.is_some() && !overwriting.force {
            return Err(VerbError::Exists { path: path.to_path_buf() });
        }
        try_folder(folder_of(path)).map_err(VerbError::write(path))?;
        earlier.push((option, name, id));
    }
    Ok(())
}

/// Checks that a bag can be written at `path`: the path is free or, with `--force`, holds a bag that this command does not
/// read.
///
/// # Errors
/// As [`check`], and [`excavator_bags::BagError`] if an existing folder is not a bag.
pub fn check_bag(path: &Path, inputs: &Inputs, overwriting: Overwriting) -> Result<(), VerbError> {
    let found = match path.symlink_metadata() {
        Ok(found) => found,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
            let nearest = path.ancestors().skip(1).find(|folder| !missing(folder)).unwrap_or(Path::new(""));
            let nearest = if nearest.as_os_str().is_empty() { Path::new(".") } else { nearest };
            return try_folder(nearest).map_err(VerbError::write(path));
        }
        Err(error) => return Err(VerbError::write(path)(error)),
    };
    if found.is_symlink() {
        return Err(VerbError::Link { path: path.to_path_buf() });
    }
    let read = Inputs::recording(path);
    if read.meets(inputs) {
        let what = "it is read by this command".to_string();
        return Err(VerbError::SameFile { option: "-o", path: path.to_path_buf(), what });
    }
    if !overwriting.force {
        return Err(VerbError::Exists { path: path.to_path_buf() });
    }
    rosbag2::check_replaceable(path)?;
    try_folder(folder_of(path)).map_err(VerbError::write(path))
}

/// The folder with links resolved, and the name in it. Two spellings of one path give the same result.
fn full_name(path: &Path) -> Result<(PathBuf, OsString), VerbError> {
    let folder = folder_of(path).canonicalize().map_err(VerbError::write(path))?;
    Ok((folder, path.file_name().unwrap_or_default().to_os_string()))
}

/// Checks that the folder is writable, with an unnamed file that disappears when it is closed.
fn try_folder(folder: &Path) -> std::io::Result<()> {
    tempfile::tempfile_in(folder).map(drop)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const FORCE: Overwriting = Overwriting { force: true };
    const CAREFUL: Overwriting = Overwriting { force: false };

    #[test]
    fn files_are_left_as_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let (old, new) = (folder.path().join("old"), folder.path().join("new"));
        std::fs::write(&old, "text").unwrap();
        let outputs: [(&str, Option<&Path>); 3] = [("-o", Some(&old)), ("--json", Some(&new)), ("--report", None)];
        check(&outputs, &Inputs::default(), FORCE).unwrap();
        let error = check(&outputs, &Inputs::default(), CAREFUL).unwrap_err().to_string();
        assert!(error.contains("old exists already") && error.contains("--force"), "{error}");
        assert_eq!(std::fs::read_to_string(&old).unwrap(), "text");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_in_use_is_not_replaced_even_with_force() {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        std::fs::create_dir(&bag).unwrap();
        let part = bag.join("bag_0.mcap");
        std::fs::write(&part, "text").unwrap();
        let hard = folder.path().join("hard");
        std::fs::hard_link(&part, &hard).unwrap();
        let new = folder.path().join("new");
        let other_way = bag.join("..").join("new");
        let inputs = Inputs::recording(&folder.path().join("bag@1..2"));
        for (outputs, expected) in [
            (vec![("--json", Some(part.as_path()))], "--json"),
            (vec![("--json", Some(hard.as_path()))], "it is read by this command"),
            (vec![("-o", Some(new.as_path())), ("--report", Some(other_way.as_path()))], "-o is the same file"),
            (vec![("-o", Some(folder.path()))], "cannot write"),
            (vec![("-o", Some(Path::new("/proc/version/x")))], "cannot write"),
        ] {
            let error = check(&outputs, &inputs, FORCE).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
        let nowhere = folder.path().join("none").join("page.html");
        let error = check(&[("--report", Some(&nowhere))], &inputs, FORCE).unwrap_err().to_string();
        assert!(error.contains("cannot write"), "{error}");
        check(&[("--json", Some(Path::new("-"))), ("--report", Some(Path::new("-")))], &inputs, CAREFUL).unwrap();
    }

    #[test]
    fn a_bag_is_replaced_only_where_it_is_one() {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        check_bag(&folder.path().join("a").join("b"), &Inputs::default(), CAREFUL).unwrap();
        std::fs::create_dir(&bag).unwrap();
        std::fs::write(bag.join("bag_0.mcap"), "text").unwrap();
        let refused = |inputs: &Inputs, overwriting| check_bag(&bag, inputs, overwriting).unwrap_err().to_string();
        assert!(refused(&Inputs::default(), CAREFUL).contains("exists already"));
        check_bag(&bag, &Inputs::default(), FORCE).unwrap();
        assert!(refused(&Inputs::recording(&bag), FORCE).contains("is read by this command"));
        assert!(refused(&Inputs::recording(&bag.join("bag_0.mcap")), FORCE).contains("is read by this command"));
        std::fs::write(bag.join("thesis.tex"), "text").unwrap();
        assert!(refused(&Inputs::default(), FORCE).contains("thesis.tex"));
        let link = folder.path().join("link");
        std::os::unix::fs::symlink(&bag, &link).unwrap();
        let error = check_bag(&link, &Inputs::default(), FORCE).unwrap_err().to_string();
        assert!(error.contains("symbolic link"), "{error}");
    }
}
