//! No input makes the reader panic, hang or take all memory: thousands of bags with flipped and missing bytes.

use crate::support::{Numbers, recording, write_small_chunks};
use excavator_bags::{Topics, read_recording};
use rosbag2::{Compression, info};

/// Broken bags per compression.
const ROUNDS: usize = 1500;

#[test]
fn flipped_bytes_and_cuts_anywhere_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    for compression in [Compression::None, Compression::Lz4, Compression::Zstd] {
        let file = write_small_chunks(&folder.path().join(format!("{compression:?}")), &recording(150), compression);
        let good = std::fs::read(&file).unwrap();
        let broken = folder.path().join("broken.mcap");
        let mut read = 0;
        for round in 0..ROUNDS {
            let mut bytes = good.clone();
            for _ in 0..numbers.below(3) + usize::from(round % 2 == 0) {
                let at = numbers.below(bytes.len());
                bytes[at] = match numbers.below(3) {
                    0 => bytes[at] ^ (1 << numbers.below(8)),
                    1 => 0xff,
                    _ => numbers.below(256) as u8,
                };
            }
            if round % 2 == 1 {
                bytes.truncate(numbers.below(bytes.len()));
            }
            std::fs::write(&broken, &bytes).unwrap();
            // Errors are fine; whatever is read must keep the promises of a recording.
            if let Ok((recording, _)) = read_recording(&broken, &Topics::default()) {
                recording.validate().unwrap();
                read += 1;
            }
        }
        assert!(read > ROUNDS / 4, "only {read} of {ROUNDS} broken bags gave any data");
    }
}

#[test]
fn every_single_cut_near_the_end_and_the_start_never_panics() {
    let folder = tempfile::tempdir().unwrap();
    let file = write_small_chunks(&folder.path().join("bag"), &recording(5), Compression::Zstd);
    let good = std::fs::read(&file).unwrap();
    let broken = folder.path().join("broken.mcap");
    for length in 0..good.len() {
        std::fs::write(&broken, &good[..length]).unwrap();
        if let Ok((recording, report)) = read_recording(&broken, &Topics::default()) {
            recording.validate().unwrap();
            assert!(!report.damage.is_empty(), "nobody noticed that {} bytes are missing", good.len() - length);
        }
        let _ = info(&broken);
    }
}
