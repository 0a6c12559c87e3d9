//! The integration tests of this crate, in one binary: each links the crate anew.

#![allow(clippy::panic, clippy::single_range_in_vec_init, clippy::unwrap_used, missing_docs)]

mod bag_matrix;
mod can_frames;
mod damage;
mod guessed_maps;
mod imperfect_messages;
mod info_of_signals;
mod interop;
mod interop_foreign;
mod map_text;
mod mapped_bags;
mod namespaces;
mod never_panics;
mod opera;
mod other_peoples_bags;
mod own_messages;
#[cfg(feature = "tables")]
mod parquet_tables;
mod real_tables;
mod round_trip;
mod samples;
mod shipped_maps;
#[cfg(feature = "tables")]
mod spreadsheets;
#[cfg(feature = "sqlite")]
mod sqlite_bags;
mod support;
mod table_matrix;
#[cfg(feature = "tables")]
mod tables;
