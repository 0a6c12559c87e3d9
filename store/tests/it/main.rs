//! The integration tests of this crate, in one binary: each links the crate anew.

#![allow(clippy::unwrap_used)]

mod objects;
mod thin;
