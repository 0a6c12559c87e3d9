//! Files that a verb is to write, looked at before it computes: a minute of work must not end in a folder that does not exist, or in
//! place of the recording it came from.

use std::fs::OpenOptions;
use std::path::{Path, PathBuf};

use crate::error::VerbError;
use crate::recording_part::Part;

/// What a verb is to write, each with the option that names it.
pub type Outputs<'a> = [(&'static str, Option<&'a Path>)];

/// Checks that every output can be written, and is neither one of the `inputs` nor another output.
///
/// # Errors
/// [`VerbError::Write`] where it cannot be written, [`VerbError::SameFile`] where that would cost a file.
pub fn check(outputs: &Outputs, inputs: &[&Path]) -> Result<(), VerbError> {
    let inputs: Vec<PathBuf> = inputs
        .iter()
        .map(|input| Part::split(input).map_or_else(|_| input.to_path_buf(), |(whole, _)| whole))
        .filter_map(|input| input.canonicalize().ok())
        .collect();
    let mut earlier: Vec<(&str, PathBuf)> = Vec::new();
    for (option, path) in outputs.iter().filter_map(|(option, path)| Some((*option, (*path)?))) {
        // Standard output, and pipes and devices, which cost nobody a file.
        if path == Path::new("-") || path.metadata().is_ok_and(|found| !found.is_file() && !found.is_dir()) {
            continue;
        }
        let place = writable(path).map_err(|source| VerbError::Write { path: path.to_path_buf(), source })?;
        let same = |what: String| VerbError::SameFile { option, path: path.to_path_buf(), what };
        if inputs.contains(&place) {
            return Err(same("it is read by this command".into()));
        }
        if let Some((other, _)) = earlier.iter().find(|(_, other)| *other == place) {
            return Err(same(format!("{other} is the same file")));
        }
        earlier.push((option, place));
    }
    Ok(())
}

/// Where the file is or would be, after it was opened for writing. Nothing of it is changed, and none is left where none was.
fn writable(path: &Path) -> std::io::Result<PathBuf> {
    let is_new = !path.exists();
    OpenOptions::new().append(true).create(true).open(path)?;
    let place = path.canonicalize();
    if is_new {
        std::fs::remove_file(path)?;
    }
    place
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn files_are_left_as_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let (old, new) = (folder.path().join("old"), folder.path().join("new"));
        std::fs::write(&old, "text").unwrap();
        check(&[("-o", Some(&old)), ("--json", Some(&new)), ("--report", None)], &[]).unwrap();
        assert_eq!(std::fs::read_to_string(&old).unwrap(), "text");
        assert!(!new.exists());
    }

    #[test]
    fn what_would_cost_a_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag.mcap");
        std::fs::write(&bag, "text").unwrap();
        let part = folder.path().join("bag.mcap@1..2");
        for (outputs, inputs, said) in [
            (vec![("--json", Some(bag.as_path()))], vec![part.as_path()], "--json"),
            (vec![("-o", Some(bag.as_path())), ("--report", Some(bag.as_path()))], vec![], "-o is the same file"),
            (vec![("-o", Some(folder.path()))], vec![], "cannot write"),
        ] {
            let error = check(&outputs, &inputs).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
        let nowhere = folder.path().join("none").join("page.html");
        assert!(check(&[("--report", Some(&nowhere))], &[]).unwrap_err().to_string().contains("cannot write"));
        check(&[("--json", Some(Path::new("-"))), ("--report", Some(Path::new("-")))], &[]).unwrap();
    }
}
