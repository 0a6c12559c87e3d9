//! Man pages: one for the program and one for each verb.

use std::path::{Path, PathBuf};

use super::command;

/// Writes all pages into a folder, which is created if it does not exist. Returns their paths.
///
/// # Errors
/// If a folder or file cannot be written.
pub fn write_man_pages(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder)?;
    clap_mangen::generate_to(command(), folder)?;
    let pages = std::fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path()));
    let mut pages = pages.collect::<Result<Vec<_>, _>>()?;
    pages.retain(|page| page.extension().is_some_and(|extension| extension == "1"));
    pages.sort();
    Ok(pages)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn every_verb_has_a_page() {
        let folder = tempfile::tempdir().unwrap();
        let pages = write_man_pages(&folder.path().join("man1")).unwrap();
        let names: Vec<_> = pages.iter().map(|page| page.file_name().unwrap().to_string_lossy().into_owned()).collect();
        for wanted in ["excavator.1", "excavator-diagnose.1", "excavator-node-arm-simulator.1"] {
            assert!(names.iter().any(|name| name == wanted), "{wanted} is not among {names:?}");
        }
        let page = std::fs::read_to_string(folder.path().join("man1/excavator-diagnose.1")).unwrap();
        assert!(page.contains("--identification") || page.contains("\\-\\-identification"), "{page}");
    }
}
