//! An object that is read by ranges.

use std::io::Write;
use std::ops::Range;
use std::path::Path as FilePath;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use bytes::Bytes;
use futures::TryStreamExt;
use object_store::path::Path;
use object_store::{GetOptions, ObjectMeta, ObjectStore};

use crate::StoreError;
use crate::opened::Place;
use crate::runtime::persistently;

/// An object of known size and content, and how many of its bytes were read.
pub(super) struct Source<'p> {
    place: &'p Place,
    path: Path,
    url: String,
    etag: Option<String>,
    pub(super) size: u64,
    read: AtomicU64,
    /// The end of the object with its offset, once it was read.
    tail: OnceLock<(u64, Bytes)>,
}

impl<'p> Source<'p> {
    pub(super) fn of(place: &'p Place, meta: &ObjectMeta) -> Self {
        Source {
            place,
            path: meta.location.clone(),
            url: place.url_of(&meta.location),
            etag: meta.e_tag.clone(),
            size: meta.size,
            read: AtomicU64::new(0),
            tail: OnceLock::new(),
        }
    }

    /// Bytes read so far.
    pub(super) fn bytes_read(&self) -> u64 {
        self.read.load(Ordering::Relaxed)
    }

    /// The last bytes of the object. They are kept, since a small bag lies completely in them.
    pub(super) async fn tail(&self, start: u64) -> Result<Bytes, StoreError> {
        let bytes = self.range(start..self.size).await?;
        let (_, kept) = self.tail.get_or_init(|| (start, bytes));
        Ok(kept.clone())
    }

    /// The cached bytes of a range, if the whole range is cached.
    fn kept(&self, range: &Range<u64>) -> Option<Bytes> {
        let (start, bytes) = self.tail.get()?;
        let place = |offset: u64| usize::try_from(offset.checked_sub(*start)?).ok();
        let (from, to) = (place(range.start)?, place(range.end)?);
        (from <= to && to <= bytes.len()).then(|| bytes.slice(from..to))
    }

    /// The bytes of a range. The content is the same on each call, if the store supports ETags.
    pub(super) async fn range(&self, range: Range<u64>) -> Result<Bytes, StoreError> {
        if let Some(kept) = self.kept(&range) {
            return Ok(kept);
        }
        let wanted = range.end.saturating_sub(range.start);
        let request = || async {
            let options =
                GetOptions { range: Some(range.clone().into()), if_match: self.etag.clone(), ..GetOptions::default() };
            self.place.store.get_opts(&self.path, options).await?.bytes().await
        };
        let found = persistently("read", &self.url, request).await?;
        self.read.fetch_add(found.len() as u64, Ordering::Relaxed);
        if found.len() as u64 != wanted {
            return Err(StoreError::Changed { url: self.url.clone() });
        }
        Ok(found)
    }

    /// Copies the whole object to a file.
    pub(super) async fn copy(&self, target: &FilePath) -> Result<(), StoreError> {
        let request = || async {
            let options = GetOptions { if_match: self.etag.clone(), ..GetOptions::default() };
            let mut pieces = self.place.store.get_opts(&self.path, options).await?.into_stream();
            let failed = |source| object_store::Error::Generic { store: "file", source: Box::new(source) };
            let mut file = std::fs::File::create(target).map_err(failed)?;
            let mut length = 0;
            while let Some(piece) = pieces.try_next().await? {
                file.write_all(&piece).map_err(failed)?;
                length += piece.len() as u64;
            }
            Ok(length)
        };
        let length: u64 = persistently("copy", &self.url, request).await?;
        self.read.fetch_add(length, Ordering::Relaxed);
        if length == self.size { Ok(()) } else { Err(StoreError::Changed { url: self.url.clone() }) }
    }
}
