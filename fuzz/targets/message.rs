//! Bytes as messages of the common types.
#![no_main]

use excavator_bags::fuzzing;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| fuzzing::message(bytes));
