//! Identifies the content at an address.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use object_store::{ObjectMeta, ObjectStoreExt};
use sha2::{Digest, Sha256};

use crate::StoreError;
use crate::objects::metas;
use crate::opened::{Options, Place, open};
use crate::runtime::{block_on, persistently};

/// Identity of the content at an address. Different contents have different identities.
///
/// - File on this machine: `sha256:` and the hash of its bytes. Times and inodes do not identify the content.
/// - Object: `etag:`, the ETag of the store, and the size. The store computed the ETag when the object was written.
///   Hashing the bytes again would mean reading every bag as a whole, which [`thin_copy`](crate::thin_copy) avoids.
///   Different bytes have different ETags. The same bytes may have another ETag after an upload in other parts; the
///   work is then only repeated.
/// - Object of a store without ETags: `modified:`, the time of its last change, and the size.
/// - Folder: `folder:` and a hash over names and identities of its objects, in subfolders too; of a folder on this machine, of the files
///   directly in it.
///
/// ```
/// use excavator_store::{Options, fingerprint};
///
/// let folder = tempfile::tempdir()?;
/// let address = folder.path().join("drive_1.mcap").display().to_string();
/// std::fs::write(&address, "content")?;
/// assert!(fingerprint(&address, &Options::new())?.starts_with("sha256:"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`StoreError::DoesNotExist`] and others.
pub fn fingerprint(url: &str, options: &Options) -> Result<String, StoreError> {
    let place = open(url, options)?;
    if let Some(file) = place.file() {
        return if file.is_dir() { of_folder(&file) } else { of_file(&file, url) };
    }
    block_on(of_objects(&place))
}

async fn of_objects(place: &Place) -> Result<String, StoreError> {
    if !place.url.ends_with('/') {
        match persistently("read", &place.url, || place.store.head(&place.path)).await {
            Ok(meta) => return Ok(named(&meta)),
            Err(StoreError::DoesNotExist { .. }) => {}
            Err(other) => return Err(other),
        }
    }
    let mut found = metas(place).await?;
    if found.is_empty() {
        return Err(StoreError::DoesNotExist { url: place.url.clone() });
    }
    found.sort_by(|one, other| one.location.cmp(&other.location));
    let mut all = Sha256::new();
    for meta in &found {
        let name = meta.location.as_ref().strip_prefix(place.path.as_ref()).unwrap_or(meta.location.as_ref());
        all.update(format!("{}\n{}\n", name.trim_start_matches('/'), named(meta)));
    }
    Ok(format!("folder:{:x}", all.finalize()))
}

fn named(meta: &ObjectMeta) -> String {
    match &meta.e_tag {
        Some(tag) => format!("etag:{}:{}", tag.trim_matches('"'), meta.size),
        // Equal sizes say nothing; the time at least never hides that an object was replaced.
        None => format!("modified:{}:{}", meta.last_modified.timestamp_micros(), meta.size),
    }
}

fn of_folder(folder: &Path) -> Result<String, StoreError> {
    let failed = |source| StoreError::File { action: "read", path: folder.to_path_buf(), source };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_file() {
            files.push(path);
        }
    }
    files.sort();
    let mut all = Sha256::new();
    for file in &files {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        all.update(format!("{name}\n{}\n", of_file(file, &file.display().to_string())?));
    }
    Ok(format!("folder:{:x}", all.finalize()))
}

fn of_file(file: &Path, url: &str) -> Result<String, StoreError> {
    let failed = |source: std::io::Error| match source.kind() {
        std::io::ErrorKind::NotFound => StoreError::DoesNotExist { url: url.to_string() },
        _ => StoreError::File { action: "read", path: file.to_path_buf(), source },
    };
    let mut opened = File::open(file).map_err(failed)?;
    let (mut hash, mut buffer) = (Sha256::new(), vec![0; 1 << 20]);
    loop {
        let read = opened.read(&mut buffer).map_err(failed)?;
        if read == 0 {
            return Ok(format!("sha256:{:x}", hash.finalize()));
        }
        hash.update(buffer.get(..read).unwrap_or_default());
    }
}
