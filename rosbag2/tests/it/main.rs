//! The integration tests of this crate, in one binary: each links the crate anew.

#![allow(clippy::panic, clippy::unwrap_used)]

mod dynamic_decoder;
mod every_shared_bag;
mod info_of_clocks;
mod raw_bags;
mod reindex_compressed;
