//! Copies bags with only the needed topics.

mod index;
mod lengths;
mod plan;
mod source;
mod writing;

use std::path::{Path as FilePath, PathBuf};

use futures::StreamExt;
use object_store::{ObjectMeta, ObjectStoreExt};

use crate::StoreError;
use crate::objects::metas;
use crate::opened::{Options, Place, open};
use crate::runtime::{block_on, persistently};

/// Number of concurrent requests for chunks. Their answers are in memory: at most 4 times 8 MiB, or four chunks if one
/// is larger.
const AT_A_TIME: usize = 4;

/// What was copied.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct ThinCopy {
    /// Path of the copy: a file, or a folder if the bag is one.
    pub path: PathBuf,
    /// Bytes read from the store.
    pub bytes_read: u64,
    /// Size of the bag, bytes.
    pub bytes_total: u64,
    /// Messages that were copied one by one, without those in files that were copied whole.
    pub messages: u64,
    /// Files that were copied whole, with the reason.
    pub whole: Vec<String>,
}

/// Why a file is copied whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Unfit(&'static str);

/// The index was good, but a chunk is damaged.
const DAMAGED: Unfit = Unfit("a damaged chunk");

/// The wanted topics.
struct Wanted<'t>(&'t [String]);

impl Wanted<'_> {
    /// Whether a topic is wanted: by its name, or by its end if the wanted name begins with `*`.
    fn has(&self, topic: &str) -> bool {
        self.0.iter().any(|one| match one.strip_prefix('*') {
            Some(end) => topic.ends_with(end),
            None => one == topic,
        })
    }
}

/// Copies the bag at `url` into the folder `target`, under its own name, with only the messages of `topics`. A name
/// that begins with `*` matches every topic that ends with the rest. Without topics the copy is whole.
///
/// For an MCAP file, the index is read first, then the chunks with wanted topics. The copy has their messages in the
/// same order, with their schemas, channels and metadata. Other files are copied whole: other formats, files without an
/// index or with a damaged one, and files in which every topic is wanted. A reader thus finds the same messages of
/// these topics, and the same damage.
///
/// A folder is copied file by file: bags, `map.toml`, and `metadata.yaml` where there are several files.
///
/// ```no_run
/// use std::path::Path;
///
/// use excavator_store::{Options, thin_copy};
///
/// let options = Options::from([("region".to_string(), "eu-central-1".to_string())]);
/// let topics = ["*/state".to_string(), "*/orifice_command".to_string()];
/// let copy = thin_copy("s3://fleet/machine_7/drive_1", Some(&topics), Path::new("kept"), &options)?;
/// println!("{} of {} bytes were read", copy.bytes_read, copy.bytes_total);
/// # Ok::<(), excavator_store::StoreError>(())
/// ```
///
/// # Errors
/// [`StoreError`] of the store or of files in `target`.
pub fn thin_copy(
    url: &str,
    topics: Option<&[String]>,
    target: &FilePath,
    options: &Options,
) -> Result<ThinCopy, StoreError> {
    let place = open(url, options)?;
    let wanted = topics.map(Wanted);
    block_on(async {
        let is_folder = url.ends_with('/') || place.file().is_some_and(|file| file.is_dir());
        if !is_folder {
            match persistently("read", url, || place.store.head(&place.path)).await {
                Ok(meta) => {
                    let mut done = ThinCopy { path: target.join(name_of(&meta)), ..ThinCopy::default() };
                    folder(target)?;
                    file(&place, &meta, wanted.as_ref(), &done.path.clone(), &mut done).await?;
                    return Ok(done);
                }
                // The address may be a folder.
                Err(StoreError::DoesNotExist { .. }) => {}
                Err(other) => return Err(other),
            }
        }
        of_folder(&place, wanted.as_ref(), target).await
    })
}

async fn of_folder(place: &Place, wanted: Option<&Wanted<'_>>, target: &FilePath) -> Result<ThinCopy, StoreError> {
    let found = metas(place).await?;
    let direct = |meta: &&ObjectMeta| {
        let parts = meta.location.prefix_match(&place.path).map(|parts| parts.count());
        parts == Some(1)
    };
    let files: Vec<&ObjectMeta> = found.iter().filter(direct).collect();
    let bags = files.iter().filter(|meta| is_bag(&name_of(meta))).count();
    if bags == 0 {
        return Err(StoreError::DoesNotExist { url: format!("{} as a bag", place.url) });
    }
    let name = place.path.filename().unwrap_or("bag").to_string();
    let mut done = ThinCopy { path: target.join(name), ..ThinCopy::default() };
    folder(&done.path)?;
    for meta in files {
        let name = name_of(meta);
        let path = done.path.join(&name);
        if is_bag(&name) {
            file(place, meta, wanted, &path, &mut done).await?;
        } else if name == "map.toml" || (name == "metadata.yaml" && (bags > 1 || wanted.is_none())) {
            file(place, meta, None, &path, &mut done).await?;
        }
    }
    Ok(done)
}

fn folder(path: &FilePath) -> Result<(), StoreError> {
    std::fs::create_dir_all(path).map_err(|source| StoreError::File {
        action: "create",
        path: path.to_path_buf(),
        source,
    })
}

fn name_of(meta: &ObjectMeta) -> String {
    meta.location.filename().unwrap_or("bag").to_string()
}

fn is_bag(name: &str) -> bool {
    let name = name.to_lowercase();
    [".mcap", ".db3", ".mcap.zstd", ".db3.zstd"].iter().any(|end| name.ends_with(end))
}

/// Copies one file: only wanted messages if possible, else the whole file.
async fn file(
    place: &Place,
    meta: &ObjectMeta,
    wanted: Option<&Wanted<'_>>,
    target: &FilePath,
    done: &mut ThinCopy,
) -> Result<(), StoreError> {
    let source = source::Source::of(place, meta);
    let name = name_of(meta);
    let unfit = match wanted {
        Some(wanted) if name.to_lowercase().ends_with(".mcap") => match thin(&source, wanted, target).await? {
            Ok(messages) => {
                done.messages += messages;
                None
            }
            Err(unfit) => Some(unfit),
        },
        Some(_) => Some(Unfit("no MCAP file")),
        None => Some(Unfit("as asked")),
    };
    if let Some(Unfit(reason)) = unfit {
        source.copy(target).await?;
        done.whole.push(format!("{name}: {reason}"));
    }
    done.bytes_read += source.bytes_read();
    done.bytes_total += source.size;
    Ok(())
}

/// Copies the wanted messages of a file and returns their number.
///
/// # Errors
/// [`StoreError`] of a request. The inner error states why the file must be copied whole.
async fn thin(
    source: &source::Source<'_>,
    wanted: &Wanted<'_>,
    target: &FilePath,
) -> Result<Result<u64, Unfit>, StoreError> {
    let index = match index::read(source).await? {
        Ok(index) => index,
        Err(unfit) => return Ok(Err(unfit)),
    };
    let plan = match plan::plan(&index, wanted) {
        Ok(plan) => plan,
        Err(unfit) => return Ok(Err(unfit)),
    };
    let Ok(mut copy) = writing::ThinFile::create(target, &index, &plan.channels) else { return Ok(Err(DAMAGED)) };
    let requests = plan.fetches.iter().map(|fetch| async move { (fetch, source.range(fetch.range.clone()).await) });
    let mut answers = futures::stream::iter(requests).buffered(AT_A_TIME);
    while let Some((fetch, answer)) = answers.next().await {
        let bytes = answer?;
        for chunk in &fetch.chunks {
            let Some(record) = bytes.get(chunk.clone()) else { return Ok(Err(DAMAGED)) };
            if copy.add(record).is_err() {
                return Ok(Err(DAMAGED));
            }
        }
    }
    Ok(copy.finish().map_err(|_| DAMAGED))
}
