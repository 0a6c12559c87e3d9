//! The target of this name in `tests/fuzzing`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| excavator_fuzzing::run("sheet", bytes));
