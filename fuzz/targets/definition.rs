//! Text as a message definition, in both languages.
#![no_main]

use excavator_bags::fuzzing;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| fuzzing::definition(bytes));
