//! What strangers, careless users and broken peers do to the program, and what it does about it.
//!
//! Every test tries one thing and asserts what happens; then it writes a row ([`fault::Fault`]) from which `table.py` makes the
//! table in `docs/faults.md`.

mod child;
mod fault;
mod files;
mod full;
mod inside;
mod readers;
