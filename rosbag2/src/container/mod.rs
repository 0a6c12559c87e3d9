//! The records of one MCAP file, read around damage.
//!
//! The `mcap` crate reads whole files in good order, or up to the first fault. Recordings of machines end with the
//! battery, so here every fault is a fact to report: the framing of records is read by hand, with seeks over what is
//! not needed, and the index at the end of the file shows the way past a broken place.

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
pub(crate) use damage_list::DamageList;
pub(crate) use mcap_file::McapFile;
