//! Text as a DBC file and as a log of a CAN bus.

use std::sync::LazyLock;

use excavator_nodes::fuzzing;

use crate::samples;

/// A log for the signals of a database to be read from.
static LOG: LazyLock<Vec<u8>> = LazyLock::new(|| samples::lines("config/can/arm.log", 2_000));
/// The database whose signals are read from logs.
static DATABASE: LazyLock<Vec<u8>> = LazyLock::new(|| samples::bytes("config/can/excavator.dbc"));

pub fn database(bytes: &[u8]) -> bool {
    fuzzing::can_database(bytes, &LOG).is_some_and(|signals| signals > 0)
}

/// # Panics
/// When a line is neither a frame nor counted.
pub fn log(bytes: &[u8]) -> bool {
    let lines = bytes.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
    let (frames, unreadable) = fuzzing::can_log(bytes, &DATABASE);
    assert!(frames + unreadable <= lines, "{frames} frames and {unreadable} unreadable of {lines} lines");
    frames > 0
}

pub fn database_seeds() -> Vec<Vec<u8>> {
    vec![samples::bytes("config/can/excavator.dbc")]
}

pub fn log_seeds() -> Vec<Vec<u8>> {
    vec![samples::lines("config/can/arm.log", 3_000)]
}
