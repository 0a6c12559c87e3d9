//! Reads the records of one MCAP file and skips damage.
//!
//! The `mcap` crate reads intact files, or stops at the first fault. Recordings of machines end with the battery, so
//! here every fault is reported and reading continues. The framing of records is parsed by hand, unneeded records are
//! skipped by seeking, and the index at the end of the file locates the next chunk after a damaged place.

mod ahead;
mod chunk;
mod damage;
mod damage_list;
mod fields;
mod framing;
mod mcap_file;
mod record;
mod registry;
mod summary;

pub use damage::{Damage, DamageKind};
#[cfg(feature = "sqlite")]
pub(crate) use damage_list::DamageList;
pub(crate) use mcap_file::McapFile;
