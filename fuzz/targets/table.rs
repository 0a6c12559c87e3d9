//! Bytes as a table: text and MATLAB.
#![no_main]

use excavator_bags::fuzzing;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| fuzzing::table(bytes));
