//! Opens the store of an address.

use std::collections::{BTreeMap, HashMap};
use std::path::{Component, Path as FilePath, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::Duration;

use object_store::aws::{AmazonS3Builder, AmazonS3ConfigKey};
use object_store::azure::{AzureConfigKey, MicrosoftAzureBuilder};
use object_store::gcp::{GoogleCloudStorageBuilder, GoogleConfigKey};
use object_store::local::LocalFileSystem;
use object_store::path::Path;
use object_store::{BackoffConfig, ObjectStore, RetryConfig};
use url::Url;

use crate::StoreError;
use crate::error::one_line;

/// Options of a store by name, as in `object_store`.
pub type Options = BTreeMap<String, String>;

/// Open stores by root address, process, options and environment. A client keeps its connections, and creating one
/// reads certificates.
type Opened = HashMap<(String, u32, Options), Arc<dyn ObjectStore>>;

static OPENED: LazyLock<Mutex<Opened>> = LazyLock::new(Mutex::default);

/// A location in a store.
#[derive(Debug, Clone)]
pub struct Place {
    /// The store.
    pub store: Arc<dyn ObjectStore>,
    /// The path in the store.
    pub path: Path,
    /// The requested address.
    pub url: String,
    root: Root,
}

/// Root of the addresses in this store.
#[derive(Debug, Clone)]
enum Root {
    /// Plain paths.
    Folder,
    /// URLs.
    Url(Url),
}

impl Place {
    /// The address of an object of the same store, in the form of this place's own address: a path or a URL.
    pub fn url_of(&self, path: &Path) -> String {
        match &self.root {
            Root::Folder => format!("/{path}"),
            Root::Url(root) => {
                let mut url = root.clone();
                url.set_path(path.as_ref());
                url.to_string()
            }
        }
    }

    /// The local file, if the store is this machine.
    pub fn file(&self) -> Option<PathBuf> {
        match &self.root {
            Root::Folder => Some(PathBuf::from(&self.url)),
            Root::Url(url) if url.scheme() == "file" => Url::parse(&self.url).ok()?.to_file_path().ok(),
            Root::Url(_) => None,
        }
    }
}

/// Retry settings of the client. Ten retries, as by default, but the first after 50 ms instead of 100, and none later
/// than 5 s. A store that fails one request in ten then fails one in 10^11 permanently, and a unit of work waits a
/// tenth of a second instead of a minute.
fn retries() -> RetryConfig {
    RetryConfig {
        backoff: BackoffConfig {
            init_backoff: Duration::from_millis(50),
            max_backoff: Duration::from_secs(5),
            base: 2.0,
        },
        max_retries: 10,
        retry_timeout: Duration::from_secs(120),
    }
}

/// Opens the store of an address. Returns the store with the path in it.
///
/// # Errors
/// [`StoreError::Address`] and [`StoreError::Option`].
pub fn open(url: &str, options: &Options) -> Result<Place, StoreError> {
    let wrong = |reason: String| StoreError::Address { url: url.to_string(), reason };
    if !url.contains("://") {
        let absolute = std::path::absolute(FilePath::new(url)).map_err(|error| wrong(error.to_string()))?;
        let absolute = without_parents(&absolute);
        let path = Path::from_absolute_path(&absolute).map_err(|error| wrong(one_line(&error)))?;
        let (store, url) = (opened("file:", options, || Ok(local()))?, absolute.display().to_string());
        return Ok(Place { store, path, url, root: Root::Folder });
    }
    let parsed = Url::parse(url).map_err(|error| wrong(error.to_string()))?;
    if parsed.scheme() == "file" {
        let file = parsed.to_file_path().map_err(|()| wrong("file URLs are absolute: file:///path".to_string()))?;
        let path = Path::from_absolute_path(&file).map_err(|error| wrong(one_line(&error)))?;
        let store = opened("file:", options, || Ok(local()))?;
        return Ok(Place { store, path, url: url.to_string(), root: Root::Url(parsed) });
    }
    if parsed.host_str().is_none_or(str::is_empty) {
        return Err(wrong("no bucket or container".to_string()));
    }
    let path = Path::from_url_path(parsed.path()).map_err(|error| wrong(one_line(&error)))?;
    let root = parsed[..url::Position::BeforePath].to_string();
    let store = opened(&root, options, || remote(&parsed, options))?;
    Ok(Place { store, path, url: url.to_string(), root: Root::Url(parsed) })
}

/// The path without `..`, which store paths do not support. Behind a symbolic link, `..` is the parent of the link
/// target.
fn without_parents(path: &FilePath) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => {
                plain = plain.canonicalize().unwrap_or(plain);
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

fn local() -> Arc<dyn ObjectStore> {
    Arc::new(LocalFileSystem::new())
}

/// The store of this root; creates it if it is not open yet.
fn opened(
    root: &str,
    options: &Options,
    make: impl FnOnce() -> Result<Arc<dyn ObjectStore>, StoreError>,
) -> Result<Arc<dyn ObjectStore>, StoreError> {
    let mut all = options.clone();
    all.extend(std::env::vars_os().filter_map(|(key, value)| {
        let (key, value) = (key.into_string().ok()?, value.into_string().ok()?);
        let is_ours = ["AWS_", "GOOGLE_", "AZURE_"].iter().any(|start| key.starts_with(start));
        is_ours.then(|| (format!("${key}"), value))
    }));
    let key = (root.to_string(), std::process::id(), all);
    let mut stores = OPENED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(store) = stores.get(&key) {
        return Ok(store.clone());
    }
    let store = make()?;
    stores.insert(key, store.clone());
    Ok(store)
}

/// A remote store.
fn remote(url: &Url, options: &Options) -> Result<Arc<dyn ObjectStore>, StoreError> {
    let wrong = |error: object_store::Error| StoreError::Address { url: url.to_string(), reason: one_line(&error) };
    let unknown = |key: &str| StoreError::Option { url: url.to_string(), key: key.to_string() };
    match url.scheme() {
        "s3" | "s3a" => {
            let mut builder = AmazonS3Builder::from_env().with_url(url.as_str()).with_retry(retries());
            for (key, value) in options {
                let known: AmazonS3ConfigKey = key.to_ascii_lowercase().parse().map_err(|_| unknown(key))?;
                builder = builder.with_config(known, value);
            }
            Ok(Arc::new(builder.build().map_err(wrong)?))
        }
        "gs" => {
            let mut builder = GoogleCloudStorageBuilder::from_env().with_url(url.as_str()).with_retry(retries());
            for (key, value) in options {
                let known: GoogleConfigKey = key.to_ascii_lowercase().parse().map_err(|_| unknown(key))?;
                builder = builder.with_config(known, value);
            }
            Ok(Arc::new(builder.build().map_err(wrong)?))
        }
        "az" | "adl" | "azure" | "abfs" | "abfss" => {
            let mut builder = MicrosoftAzureBuilder::from_env().with_url(url.as_str()).with_retry(retries());
            for (key, value) in options {
                let known: AzureConfigKey = key.to_ascii_lowercase().parse().map_err(|_| unknown(key))?;
                builder = builder.with_config(known, value);
            }
            Ok(Arc::new(builder.build().map_err(wrong)?))
        }
        other => Err(StoreError::Address {
            url: url.to_string(),
            reason: format!("no store has \"{other}://\"; there are s3, gs, az and file"),
        }),
    }
}
