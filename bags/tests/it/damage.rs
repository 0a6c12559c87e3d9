//! Files that were cut, or of which a part is broken: what is good is read, what is lost is counted.

use crate::support;
use std::path::{Path, PathBuf};

use crate::support::{add, assert_equal, mcap_file, recording, state, write_small_chunks};
use excavator_bags::{BagError, ReadReport, Topics, read_recording};
use excavator_model::recording::Recording;
use mcap::records::ChunkIndex;
use rosbag2::{BagWriter, Compression, DamageKind, WriteOptions};

const SAMPLES: usize = 3000;

struct Bag {
    _folder: tempfile::TempDir,
    file: PathBuf,
    bytes: Vec<u8>,
    chunks: Vec<ChunkIndex>,
}

fn bag(compression: Compression) -> Bag {
    let folder = tempfile::tempdir().unwrap();
    let file = write_small_chunks(&folder.path().join("bag"), &recording(SAMPLES), compression);
    let bytes = std::fs::read(&file).unwrap();
    let mut chunks = mcap::Summary::read(&bytes).unwrap().unwrap().chunk_indexes;
    chunks.sort_by_key(|chunk| chunk.chunk_start_offset);
    Bag { _folder: folder, file, bytes, chunks }
}

impl Bag {
    fn read(&self, bytes: &[u8]) -> Result<(Recording, ReadReport), BagError> {
        std::fs::write(&self.file, bytes).unwrap();
        read_recording(&self.file, &Topics::default())
    }

    fn end_of_data(&self) -> usize {
        let last = self.chunks.last().unwrap();
        (last.chunk_start_offset + last.chunk_length + last.message_index_length) as usize
    }
}

/// Panics unless `found` is the beginning of the recording.
fn assert_is_beginning(found: &Recording) {
    let mut expected = recording(SAMPLES);
    for values in expected.columns_mut() {
        values.truncate(found.len());
    }
    assert_equal(found, &expected);
}

#[test]
fn a_cut_file_is_read_to_the_cut() {
    for compression in [Compression::None, Compression::Lz4, Compression::Zstd] {
        let bag = bag(compression);
        let third = &bag.chunks[2];
        let cut = (third.chunk_start_offset + third.chunk_length / 2) as usize;
        let (found, report) = bag.read(&bag.bytes[..cut]).unwrap();
        assert_is_beginning(&found);
        let last_whole_chunk_ends = (bag.chunks[1].message_end_time as i64 - support::START) as f64 / 1e9;
        assert!(found.duration() >= last_whole_chunk_ends - 0.01, "{compression:?}");
        let truncated_after = report.truncated_after.unwrap();
        assert!((truncated_after - found.duration()).abs() < 0.003, "{truncated_after} {}", found.duration());
        assert!(report.lost_bytes() >= third.chunk_length / 2, "{compression:?} {}", report.lost_bytes());
        let [damage] = report.damage.as_slice() else { panic!("{:?}", report.damage) };
        assert_eq!(damage.offset, third.chunk_start_offset);
        let DamageKind::CutOff { recovered_messages } = damage.kind else { panic!("{damage}") };
        // Without compression every message before the cut is there; zstd and lz4 give whole blocks only.
        if compression == Compression::None {
            assert!(recovered_messages > 10);
        }
    }
}

#[test]
fn a_file_that_was_flushed_but_not_closed_is_whole_up_to_there() {
    let bag = bag(Compression::Zstd);
    let (found, report) = bag.read(&bag.bytes[..bag.end_of_data()]).unwrap();
    assert_equal(&found, &recording(SAMPLES));
    assert_eq!(report.lost_bytes(), 0);
    assert_eq!(report.damage[0].kind, DamageKind::NotClosed);
    assert!((report.truncated_after.unwrap() - found.duration()).abs() < 1e-9);
}

#[test]
fn flush_makes_everything_before_it_readable() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag");
    let mut writer = BagWriter::create(&path, &WriteOptions::default()).unwrap();
    for stamp in 0..10 {
        add(&mut writer, "/arm/state", &state(stamp, &["arm"]));
    }
    writer.flush().unwrap();
    add(&mut writer, "/arm/state", &state(10, &["arm"]));
    let (found, report) = read_recording(&path, &Topics::default()).unwrap();
    assert_eq!(found.len(), 10);
    assert_eq!(report.damage.len(), 1);
    assert!(!path.join("metadata.yaml").exists());
    drop(writer);
    let (found, report) = read_recording(&path, &Topics::default()).unwrap();
    assert_eq!((found.len(), report.problems()), (11, vec![]));
}

#[test]
fn a_chunk_with_a_wrong_checksum_is_left_out_and_counted() {
    for compression in [Compression::None, Compression::Lz4, Compression::Zstd] {
        let bag = bag(compression);
        let second = &bag.chunks[1];
        let mut bytes = bag.bytes.clone();
        bytes[(second.chunk_start_offset + second.chunk_length / 2) as usize] ^= 0x10;
        let (found, report) = bag.read(&bytes).unwrap();
        assert_eq!(report.bad_chunks(), 1, "{compression:?}");
        assert_eq!(report.lost_bytes(), second.chunk_length);
        assert_eq!(report.truncated_after, None);
        assert!(found.len() > SAMPLES / 2 && found.len() < SAMPLES);
        assert_eq!(report.gaps.len(), 1);
        assert!((found.duration() - recording(SAMPLES).duration()).abs() < 1e-9);
    }
}

#[test]
fn the_first_chunk_with_all_definitions_may_be_lost() {
    let bag = bag(Compression::Zstd);
    let first = &bag.chunks[0];
    let mut bytes = bag.bytes.clone();
    bytes[(first.chunk_start_offset + first.chunk_length / 2) as usize] ^= 0x10;
    let (found, report) = bag.read(&bytes).unwrap();
    assert!(found.len() > SAMPLES / 2);
    assert_eq!(report.bad_chunks(), 1);
    // Without the summary nobody knows what the other messages are.
    let error = bag.read(&bytes[..bag.end_of_data()]).unwrap_err();
    assert!(matches!(&error, BagError::NoMessages { damage, .. } if damage.len() == 3), "{error}");
}

#[test]
fn a_broken_record_in_the_middle_is_passed_over_with_the_index() {
    let bag = bag(Compression::Zstd);
    let offset = bag.chunks[1].chunk_start_offset as usize;
    for broken in [offset, offset + 1, offset + 6] {
        let mut bytes = bag.bytes.clone();
        bytes[broken] ^= 0x40;
        let (found, report) = bag.read(&bytes).unwrap();
        assert!(found.len() > SAMPLES / 2 && found.len() < SAMPLES, "byte {broken}: {}", found.len());
        assert!(!report.damage.is_empty());
        assert!((found.duration() - recording(SAMPLES).duration()).abs() < 1e-9, "byte {broken}");
    }
}

#[test]
fn split_bags_are_read_in_order_and_with_one_broken_part() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag");
    std::fs::create_dir(&path).unwrap();
    for part in 0..11 {
        let one = folder.path().join("part");
        let mut writer = BagWriter::create(&one, &WriteOptions::default()).unwrap();
        add(&mut writer, "/arm/state", &state(part, &["arm"]));
        writer.finish().unwrap();
        std::fs::rename(mcap_file(&one), path.join(format!("bag_{part}.mcap"))).unwrap();
        std::fs::remove_dir_all(one).unwrap();
    }
    let read = |path: &Path| read_recording(path, &Topics::default()).unwrap();
    let (found, report) = read(&path);
    assert_eq!((found.len(), report.reordered), (11, 0), "files must be read in the order of their numbers");
    let files = "[bag_3.mcap, bag_1.mcap]";
    let text = format!(
        "rosbag2_bagfile_information:\n  storage_identifier: mcap\n  message_count: 3\n  relative_file_paths: {files}\n"
    );
    std::fs::write(path.join("metadata.yaml"), text).unwrap();
    let (found, report) = read(&path);
    assert_eq!((found.len(), report.reordered, report.missing_messages), (2, 1, 1));
    std::fs::write(path.join("bag_3.mcap"), "").unwrap();
    let (found, report) = read(&path);
    assert_eq!(found.len(), 1);
    assert_eq!(report.damage[0].kind, DamageKind::UnknownFormat);
}
