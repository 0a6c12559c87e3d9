//! Errors of stores.

use std::path::PathBuf;

use thiserror::Error;

/// Why an object cannot be read or written, in one line.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StoreError {
    /// Neither a URL of a known store nor a path.
    #[error("{url} is no address of a store: {reason}")]
    Address {
        /// The address.
        url: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The store of this address does not have this option.
    #[error("{url}: a store of this kind has no option \"{key}\"")]
    Option {
        /// The address.
        url: String,
        /// The option.
        key: String,
    },
    /// The object does not exist.
    #[error("{url} does not exist")]
    DoesNotExist {
        /// The address.
        url: String,
    },
    /// The store does not support conditional creation.
    #[error(
        "{url}: this store cannot write an object only where there is none ({reason}); use another store for results"
    )]
    NoCreate {
        /// The address.
        url: String,
        /// Message of the store.
        reason: String,
    },
    /// The store refuses access with these credentials.
    #[error("{url}: the store refuses access: {reason}")]
    Access {
        /// The address.
        url: String,
        /// Message of the store.
        reason: String,
    },
    /// The object was replaced while it was read.
    #[error("{url} changed while it was read")]
    Changed {
        /// The address.
        url: String,
    },
    /// The object is larger than the limit.
    #[error("{url} has {size} bytes, more than {limit}")]
    TooLarge {
        /// The address.
        url: String,
        /// Its size, bytes.
        size: u64,
        /// Limit, bytes.
        limit: u64,
    },
    /// The store or the network failed on every attempt.
    #[error("cannot {action} {url}: {attempts} attempts failed, the last with: {reason}")]
    Failed {
        /// The action: "read", "write", ...
        action: &'static str,
        /// The address.
        url: String,
        /// Number of attempts.
        attempts: u32,
        /// Message of the store.
        reason: String,
    },
    /// An error of a local file.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// The action: "create", "write", ...
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// No runtime for requests.
    #[error("cannot start a runtime for requests: {0}")]
    Runtime(std::io::Error),
}

impl StoreError {
    /// Whether a repeated request may succeed: the request itself is not at fault.
    pub fn is_passing(&self) -> bool {
        matches!(self, StoreError::Failed { .. } | StoreError::Changed { .. } | StoreError::Runtime(_))
    }

    /// Converts `source`, which occurred at `url`.
    pub(crate) fn of(source: object_store::Error, action: &'static str, url: &str, attempts: u32) -> Self {
        use object_store::Error as Given;
        let (url, reason) = (url.to_string(), one_line(&source));
        match source {
            Given::NotFound { .. } => StoreError::DoesNotExist { url },
            Given::Precondition { .. } | Given::NotModified { .. } => StoreError::Changed { url },
            Given::NotImplemented { .. } | Given::NotSupported { .. } => StoreError::NoCreate { url, reason },
            Given::PermissionDenied { .. } | Given::Unauthenticated { .. } => StoreError::Access { url, reason },
            Given::InvalidPath { .. } => StoreError::Address { url, reason },
            _ => StoreError::Failed { action, url, attempts, reason },
        }
    }
}

/// An error with all its causes in one line of at most 400 characters, since stores return whole pages.
pub(crate) fn one_line(error: &dyn std::fmt::Display) -> String {
    let text = error.to_string();
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").chars().take(400).collect()
}
