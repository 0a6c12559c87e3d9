//! Why a store cannot be used.

use std::path::PathBuf;

use thiserror::Error;

/// Something that cannot be read from a store or written to it, in one line.
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
    /// An option that the store of this address does not have.
    #[error("{url}: a store of this kind has no option \"{key}\"")]
    Option {
        /// The address.
        url: String,
        /// The option.
        key: String,
    },
    /// Nothing is there.
    #[error("{url} does not exist")]
    DoesNotExist {
        /// The address.
        url: String,
    },
    /// The store cannot write an object only where there is none.
    #[error(
        "{url}: this store cannot write an object only where there is none ({reason}); use another store for results"
    )]
    NoCreate {
        /// The address.
        url: String,
        /// What the store says.
        reason: String,
    },
    /// Others may read or write there, but not with these keys.
    #[error("{url}: the store refuses access: {reason}")]
    Access {
        /// The address.
        url: String,
        /// What the store says.
        reason: String,
    },
    /// An object that was replaced while it was read.
    #[error("{url} changed while it was read")]
    Changed {
        /// The address.
        url: String,
    },
    /// An object that is larger than what is asked for can be.
    #[error("{url} has {size} bytes, more than {limit}")]
    TooLarge {
        /// The address.
        url: String,
        /// Its size, bytes.
        size: u64,
        /// What it may have, bytes.
        limit: u64,
    },
    /// The store or the network failed, and went on failing.
    #[error("cannot {action} {url}: {attempts} attempts failed, the last with: {reason}")]
    Failed {
        /// What was tried: "read", "write", ...
        action: &'static str,
        /// The address.
        url: String,
        /// How often it was tried.
        attempts: u32,
        /// What the store says.
        reason: String,
    },
    /// A file on this machine.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// What was tried: "create", "write", ...
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// No runtime for requests.
    #[error("cannot start a runtime for requests: {0}")]
    Runtime(std::io::Error),
}

impl StoreError {
    /// Whether the same request may well succeed later: nothing is wrong with what was asked for.
    pub fn is_passing(&self) -> bool {
        matches!(self, StoreError::Failed { .. } | StoreError::Changed { .. } | StoreError::Runtime(_))
    }

    /// What `source` means for `url`.
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

/// An error with all its causes in one line of at most 400 characters: stores answer with pages.
pub(crate) fn one_line(error: &dyn std::fmt::Display) -> String {
    let text = error.to_string();
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").chars().take(400).collect()
}
