//! Reads and writes whole objects: documents and results.

use futures::TryStreamExt;
use object_store::{GetOptions, ObjectMeta, ObjectStore, ObjectStoreExt, PutMode, PutOptions, PutPayload};

use crate::opened::{Options, Place, open};
use crate::runtime::{block_on, persistently};
use crate::{StoreError, error::one_line};

/// Largest document or table of results, bytes. Bags are larger, but are never in memory as a whole.
const LARGEST: u64 = 1 << 30;

/// An object of a store.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Entry {
    /// Its address.
    pub url: String,
    /// Its size, bytes.
    pub size: u64,
    /// ETag of the store, if any.
    pub etag: Option<String>,
    /// When it was written, ns since the Unix epoch.
    pub last_modified: i64,
}

impl Entry {
    pub(crate) fn of(place: &Place, meta: &ObjectMeta) -> Self {
        Entry {
            url: place.url_of(&meta.location),
            size: meta.size,
            etag: meta.e_tag.clone(),
            last_modified: meta.last_modified.timestamp_nanos_opt().unwrap_or_default(),
        }
    }
}

/// The content of an object.
///
/// # Errors
/// [`StoreError`]; [`StoreError::TooLarge`] for more than 1 GiB.
pub fn get(url: &str, options: &Options) -> Result<Vec<u8>, StoreError> {
    let place = open(url, options)?;
    block_on(async {
        let size = persistently("read", url, || place.store.head(&place.path)).await?.size;
        if size > LARGEST {
            return Err(StoreError::TooLarge { url: url.to_string(), size, limit: LARGEST });
        }
        content(&place).await
    })
}

/// The content of an object whose size is known to be within the limit.
async fn content(place: &Place) -> Result<Vec<u8>, StoreError> {
    let request = || async { place.store.get_opts(&place.path, GetOptions::default()).await?.bytes().await };
    persistently("read", &place.url, request).await.map(Vec::from)
}

/// Writes an object, replacing an existing one.
///
/// # Errors
/// [`StoreError`].
pub fn put(url: &str, content: &[u8], options: &Options) -> Result<(), StoreError> {
    let place = open(url, options)?;
    let payload = PutPayload::from(content.to_vec());
    let request = || place.store.put(&place.path, payload.clone());
    block_on(persistently("write", url, request)).map(drop)
}

/// Writes an object only if there is none. Returns whether the object now has this content. If several writers write
/// different contents at the same time, one of them succeeds. If another writer wrote the same bytes, both get `true`.
///
/// # Errors
/// [`StoreError::NoCreate`] if the store does not support this request; others.
pub fn put_if_absent(url: &str, content: &[u8], options: &Options) -> Result<bool, StoreError> {
    let place = open(url, options)?;
    block_on(create(&place, content))
}

/// As [`put_if_absent`]. If an attempt failed after its bytes had arrived, the next one finds its own object with the
/// same bytes. The client library retries by itself without reporting it, so every existing object is compared.
async fn create(place: &Place, content: &[u8]) -> Result<bool, StoreError> {
    let payload = PutPayload::from(content.to_vec());
    let request = || {
        let (store, path, payload) = (place.store.clone(), place.path.clone(), payload.clone());
        async move {
            let options = PutOptions { mode: PutMode::Create, ..PutOptions::default() };
            match store.put_opts(&path, payload, options).await {
                Ok(_) => Ok(Ok(true)),
                Err(object_store::Error::AlreadyExists { .. }) => Ok(Ok(false)),
                // Not retried: the store does not support the request.
                Err(error @ object_store::Error::NotImplemented { .. }) => Ok(Err(one_line(&error))),
                Err(error) => Err(error),
            }
        }
    };
    match persistently("write", &place.url, request).await? {
        Ok(true) => Ok(true),
        Ok(false) => Ok(self::content(place).await? == content),
        Err(reason) => Err(StoreError::NoCreate { url: place.url.clone(), reason }),
    }
}

/// All objects in a folder and its subfolders, sorted by address. Empty if there is no such folder.
///
/// # Errors
/// [`StoreError`].
pub fn list(url: &str, options: &Options) -> Result<Vec<Entry>, StoreError> {
    let place = open(url, options)?;
    let mut found: Vec<Entry> = block_on(metas(&place))?.iter().map(|meta| Entry::of(&place, meta)).collect();
    found.sort_by(|one, other| one.url.cmp(&other.url));
    Ok(found)
}

/// Metadata of all objects below a place.
pub(crate) async fn metas(place: &Place) -> Result<Vec<ObjectMeta>, StoreError> {
    persistently("list", &place.url, || place.store.list(Some(&place.path)).try_collect()).await
}

/// Metadata of an object.
///
/// # Errors
/// [`StoreError::DoesNotExist`] and others.
pub fn head(url: &str, options: &Options) -> Result<Entry, StoreError> {
    let place = open(url, options)?;
    let meta = block_on(persistently("read", url, || place.store.head(&place.path)))?;
    Ok(Entry::of(&place, &meta))
}
