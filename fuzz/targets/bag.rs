//! Bytes as the file of a bag: MCAP, SQLite3, compressed.
#![no_main]

use excavator_bags::fuzzing;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| fuzzing::bag(bytes));
