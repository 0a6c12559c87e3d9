//! Builds `docs/` into a site: `cargo run -p excavator-book` writes it to `target/book`.

use std::path::{Path, PathBuf};

use mdbook_driver::MDBook;
use mdbook_driver::errors::Result;

/// Builds the book of `docs` into `site`, which may exist, and returns the pages of its table of contents.
///
/// # Errors
/// A page of the table of contents that does not exist, or a folder that cannot be written.
pub fn build(docs: &Path, site: &Path) -> Result<Vec<PathBuf>> {
    let mut book = MDBook::load(docs)?;
    book.config.build.build_dir = site.to_path_buf();
    book.build()?;
    Ok(book.book.chapters().filter_map(|chapter| chapter.path.clone()).collect())
}

/// The folder `docs` of the project.
pub fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}
