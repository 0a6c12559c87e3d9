//! Object storage for fleets of machines: S3, GCS, Azure and files behind one set of functions.
//!
//! An address is a URL (`s3://bucket/path`, `gs://bucket/path`, `az://container/path`, `file:///path`) or a plain path.
//! [`Options`] are those of the crate `object_store` (`endpoint`, `allow_http`, `region`, `access_key_id`, ...). They
//! override environment variables (`AWS_*`, `GOOGLE_*`, `AZURE_*`).
//!
//! [`thin_copy`] copies only the needed topics of an MCAP bag: it reads the index at the end of the file, and then the
//! chunks with wanted topics.
//!
//! Every function blocks. Requests run on one runtime per process, so that connections are reused. Failed requests are
//! retried.
//!
//! ```
//! use excavator_store::{Options, get, list, put_if_absent};
//!
//! let folder = tempfile::tempdir()?;
//! let results = format!("file://{}/results", folder.path().display());
//! let (address, options) = (format!("{results}/drive_1.json"), Options::new());
//! assert!(put_if_absent(&address, b"first", &options)?);
//! assert!(!put_if_absent(&address, b"second", &options)?);
//! assert_eq!(get(&address, &options)?, b"first");
//! assert_eq!(list(&results, &options)?.len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod fingerprint;
mod objects;
mod opened;
mod runtime;
mod thin;

pub use error::StoreError;
pub use objects::{Entry, get, head, list, put, put_if_absent};
pub use opened::{Options, Place, open};
pub use thin::{ThinCopy, thin_copy};

pub use fingerprint::fingerprint;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
