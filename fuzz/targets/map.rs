//! Text as a topic map.
#![no_main]

use excavator_bags::fuzzing;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| fuzzing::map(bytes));
