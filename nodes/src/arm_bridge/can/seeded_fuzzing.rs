//! DBC files and logs with flipped, cut, repeated and inserted bytes, with a fixed seed: nothing panics, nothing hangs.
#![allow(clippy::unwrap_used)]

use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::log::frames;
use super::{Counts, Database, Wanted};

const DBC: &[u8] = include_bytes!("../../../../config/can/excavator.dbc");
const LOG: &[u8] = include_bytes!("../../../../config/can/arm.log");
/// Longest time for one text: an honest one takes a thousandth of that.
const LONGEST: Duration = Duration::from_secs(2);

/// A few changes of the kinds that fuzzers make.
fn mutated(good: &[u8], numbers: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = good.to_vec();
    for _ in 0..numbers.random_range(1..7) {
        let at = numbers.random_range(0..bytes.len().max(1));
        let end = (at + numbers.random_range(0..40)).min(bytes.len());
        match numbers.random_range(0..7) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << numbers.random_range(0..8),
            1 if !bytes.is_empty() => bytes[at] = [0, 0x7f, 0x80, 0xff][numbers.random_range(0..4)],
            2 if numbers.random_bool(0.2) => bytes.truncate(at),
            3 => bytes.insert(at, numbers.random()),
            4 => {
                let part = bytes[at.min(end)..end].to_vec();
                let to = numbers.random_range(0..=bytes.len());
                bytes.splice(to..to, part);
            }
            // Digits are what these texts are made of.
            5 => {
                let digits: Vec<usize> = (0..bytes.len()).filter(|at| bytes[*at].is_ascii_digit()).collect();
                if let Some(at) = digits.get(numbers.random_range(0..digits.len().max(1))) {
                    bytes[*at] = b'0' + numbers.random_range(0..10);
                }
            }
            _ => {
                bytes.drain(at.min(end)..end);
            }
        }
    }
    bytes
}

/// Everything that the bridge does with a DBC file, and what of it was understood.
fn use_database(bytes: &[u8]) -> Option<usize> {
    let database = Database::parse(bytes).ok()?;
    let mut places = Vec::new();
    for (message, signal) in database.all_signals() {
        places.extend(database.place(&message, &signal).ok());
    }
    let understood = places.len();
    let wanted = Wanted { places };
    let counts = Counts::default();
    let lines = &LOG[..LOG.len().min(2_000)];
    for logged in frames(lines, None, &counts) {
        wanted.read(&logged.frame, &counts, |_, _| {});
    }
    Some(understood)
}

fn timed<T>(what: &[u8], work: impl FnOnce(&[u8]) -> T) -> T {
    let start = Instant::now();
    let outcome = work(what);
    let took = start.elapsed();
    assert!(took < LONGEST, "{took:?} for {}", String::from_utf8_lossy(what));
    outcome
}

#[test]
fn databases() {
    let mut numbers = ChaCha8Rng::seed_from_u64(0x5eed_0f00_d15e_a5e5);
    assert!(use_database(DBC).unwrap() > 5);
    let (mut understood, mut refused) = (0, 0);
    for _ in 0..1_500 {
        match timed(&mutated(DBC, &mut numbers), use_database) {
            Some(_) => understood += 1,
            None => refused += 1,
        }
    }
    // Both ways were gone.
    assert!(understood > 50 && refused > 50, "{understood} understood, {refused} refused");
}

#[test]
fn deep_and_long_databases() {
    let nested = "(".repeat(100_000);
    let quoted = format!("VERSION \"{}", "\\\"".repeat(100_000));
    let blank = " \n".repeat(200_000);
    let signals = format!("BO_ 1 M: 8 N\n{}", " SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n".repeat(5_000));
    for text in [nested, quoted, blank, signals] {
        timed(text.as_bytes(), |bytes| Database::parse(bytes).map(|_| ()).unwrap_or_default());
    }
}

#[test]
fn logs() {
    let mut numbers = ChaCha8Rng::seed_from_u64(0x10_95);
    let database = Database::parse(DBC).unwrap();
    let signals = database.all_signals();
    let places = signals.iter().filter_map(|(message, signal)| database.place(message, signal).ok()).collect();
    let wanted = Wanted { places };
    let good = &LOG[..3_000];
    let lines = good.iter().filter(|byte| **byte == b'\n').count() as u64;
    for _ in 0..3_000 {
        let text = mutated(good, &mut numbers);
        let counts = Counts::default();
        let mut found = 0;
        timed(&text, |text| {
            for logged in frames(text, None, &counts) {
                found += 1;
                wanted.read(&logged.frame, &counts, |_, _| {});
            }
        });
        let unreadable = counts.unreadable.into_inner();
        // Every line is a frame or counted; a change adds a few lines at most.
        assert!(found + unreadable <= lines + 20, "{found} frames, {unreadable} unreadable of {lines} lines");
    }
}
