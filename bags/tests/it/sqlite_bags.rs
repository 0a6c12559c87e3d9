//! SQLite3 bags: the same recording as from MCAP, whole, split, compressed, without definitions, cut and broken.

use std::path::{Path, PathBuf};

use crate::support::{Numbers, assert_equal, recording, to_sqlite};
use excavator_bags::{BagError, ReadReport, Topics, read_recording, write_recording};
use excavator_model::recording::Recording;
use rosbag2::{DamageKind, RawMessages, WriteOptions, info};

const SAMPLES: usize = 1500;

struct Database {
    folder: tempfile::TempDir,
    file: PathBuf,
    bytes: Vec<u8>,
    messages: usize,
}

fn database() -> Database {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    write_recording(&bag, &recording(SAMPLES), &Topics::default(), &WriteOptions::default()).unwrap();
    let file = folder.path().join("bag_0.db3");
    to_sqlite(&bag, &file);
    let bytes = std::fs::read(&file).unwrap();
    let messages = RawMessages::open(&bag).unwrap().count();
    Database { folder, file, bytes, messages }
}

fn read(path: &Path) -> Result<(Recording, ReadReport), BagError> {
    read_recording(path, &Topics::default())
}

fn zstd(bytes: &[u8]) -> Vec<u8> {
    zstd::encode_all(bytes, 3).unwrap()
}

#[test]
fn it_is_the_same_recording() {
    let database = database();
    let (found, report) = read(&database.file).unwrap();
    assert_eq!(report.damage, []);
    assert_equal(&found, &recording(SAMPLES));
}

#[test]
fn a_whole_file_may_be_compressed_and_cut() {
    let database = database();
    let packed = database.folder.path().join("bag_0.db3.zstd");
    let bytes = zstd(&database.bytes);
    std::fs::write(&packed, &bytes).unwrap();
    let (found, report) = read(&packed).unwrap();
    assert_eq!(report.damage, []);
    assert_equal(&found, &recording(SAMPLES));
    std::fs::write(&packed, &bytes[..bytes.len() * 2 / 3]).unwrap();
    let (found, report) = read(&packed).unwrap();
    assert!(found.len() > SAMPLES / 4, "{}", found.len());
    assert!(report.damage.iter().any(|damage| matches!(damage.kind, DamageKind::BadCompression { .. })));
    assert!(report.damage.iter().all(|damage| damage.file == packed), "{:?}", report.damage);
    assert!(report.truncated_after.is_some());
}

#[test]
fn messages_may_be_compressed_one_by_one() {
    let database = database();
    let connection = rusqlite::Connection::open(&database.file).unwrap();
    let rows: Vec<(i64, Vec<u8>)> = {
        let mut statement = connection.prepare("SELECT id, data FROM messages").unwrap();
        let rows = statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?))).unwrap();
        rows.map(Result::unwrap).collect()
    };
    connection.execute_batch("BEGIN").unwrap();
    for (id, data) in rows {
        let packed = zstd(&data);
        // Every hundredth is broken.
        let packed = if id % 100 == 0 { packed[..packed.len() / 2].to_vec() } else { packed };
        connection.execute("UPDATE messages SET data = ?1 WHERE id = ?2", rusqlite::params![packed, id]).unwrap();
    }
    connection.execute_batch("COMMIT").unwrap();
    let (found, report) = read(&database.file).unwrap();
    let broken = (database.messages / 100) as u64;
    let [damage] = report.damage.as_slice() else { panic!("{:?}", report.damage) };
    assert!(matches!(damage.kind, DamageKind::BadMessages { messages, .. } if messages == broken), "{damage}");
    assert!(found.len() >= SAMPLES - broken as usize && found.len() < SAMPLES);
}

#[test]
fn early_versions_have_no_definitions_and_no_qos() {
    let database = database();
    let connection = rusqlite::Connection::open(&database.file).unwrap();
    connection
        .execute_batch(
            "DROP TABLE message_definitions; DROP TABLE schema;
             ALTER TABLE topics DROP COLUMN type_description_hash; ALTER TABLE topics DROP COLUMN offered_qos_profiles;",
        )
        .unwrap();
    drop(connection);
    let (found, report) = read(&database.file).unwrap();
    assert_eq!(report.damage, []);
    assert_equal(&found, &recording(SAMPLES));
}

#[test]
fn a_cut_file_is_read_to_the_cut_and_says_how_much_is_missing() {
    let database = database();
    let whole = recording(SAMPLES);
    for percent in [30, 60, 90, 99] {
        let cut = database.bytes.len() * percent / 100;
        std::fs::write(&database.file, &database.bytes[..cut]).unwrap();
        let (found, report) = read(&database.file).unwrap();
        let expected = SAMPLES * percent / 100;
        assert!(found.len() > expected * 8 / 10, "{percent} %: {} of about {expected} samples", found.len());
        // Cut pages have no order in time, so single samples may be missing, but none is wrong.
        for (sample, time) in found.time.iter().enumerate() {
            let index = whole.time.iter().position(|t| (t - time).abs() < 1e-9).unwrap();
            let (a, b) = (&found.cylinders[0].displacement[sample], &whole.cylinders[0].displacement[index]);
            assert_eq!(a, b, "{percent} %, sample {sample}");
        }
        let missing = (database.bytes.len() - cut) as u64;
        let truncation = report.damage.iter().find(|damage| damage.is_truncation()).unwrap();
        assert_eq!((truncation.lost_bytes, &truncation.kind), (missing, &DamageKind::CutDatabase), "{percent} %");
        assert!(report.truncated_after.unwrap() > 0.0);
    }
}

#[test]
fn broken_pages_cost_their_messages_only_and_they_are_counted() {
    let database = database();
    let pages = database.bytes.len() / 4096;
    let mut bytes = database.bytes.clone();
    // Three neighbours in the middle: at least one holds messages, none of them the root.
    bytes[4096 * (pages / 2)..4096 * (pages / 2 + 3)].fill(0xff);
    std::fs::write(&database.file, &bytes).unwrap();
    let mut messages = RawMessages::open(&database.file).unwrap();
    let read = messages.by_ref().map(Result::unwrap).count();
    let lost: u64 = messages
        .damage()
        .iter()
        .map(|damage| match &damage.kind {
            DamageKind::LostRows { messages: Some(messages), .. } => *messages,
            other => panic!("{other:?}"),
        })
        .sum();
    assert!(lost > 0);
    assert_eq!(read + lost as usize, database.messages);
    assert!(lost < 100, "{lost} messages lost");
}

#[test]
fn what_a_killed_writer_left_beside_the_file_is_read_too() {
    let database = database();
    let connection = rusqlite::Connection::open(&database.file).unwrap();
    connection.execute_batch("PRAGMA journal_mode=WAL; PRAGMA wal_autocheckpoint=0;").unwrap();
    connection.execute("INSERT INTO messages SELECT NULL, topic_id, timestamp + 1, data FROM messages", []).unwrap();
    // Copied while it is open: as after a power cut, with the new messages in the -wal file only.
    let copy = database.folder.path().join("copy.db3");
    std::fs::copy(&database.file, &copy).unwrap();
    std::fs::copy(database.folder.path().join("bag_0.db3-wal"), database.folder.path().join("copy.db3-wal")).unwrap();
    let count = RawMessages::open(&copy).unwrap().map(Result::unwrap).count();
    assert_eq!(count, 2 * database.messages);
}

#[test]
fn split_folders_are_read_in_order_and_metadata_is_held_to_its_promise() {
    let database = database();
    let folder = database.folder.path().join("split");
    std::fs::create_dir(&folder).unwrap();
    for number in [0, 1, 10, 2] {
        std::fs::copy(&database.file, folder.join(format!("split_{number}.db3"))).unwrap();
    }
    let found = info(&folder).unwrap();
    let names: Vec<String> =
        found.files.iter().map(|file| file.file_name().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(names, ["split_0.db3", "split_1.db3", "split_2.db3", "split_10.db3"]);
    assert_eq!(found.message_count, 4 * database.messages as u64);
    let metadata = format!(
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  message_count: {}\n  \
         relative_file_paths: [split_0.db3]\n",
        database.messages + 7
    );
    std::fs::write(folder.join("metadata.yaml"), metadata).unwrap();
    let (_, report) = read(&folder).unwrap();
    assert_eq!(report.missing_messages, 7);
    // Compressed after metadata.yaml was written, as `zstd --rm` does.
    std::fs::write(folder.join("split_0.db3.zstd"), zstd(&database.bytes)).unwrap();
    std::fs::remove_file(folder.join("split_0.db3")).unwrap();
    let (found, _) = read(&folder).unwrap();
    assert_equal(&found, &recording(SAMPLES));
}

#[test]
fn flipped_bytes_and_cuts_anywhere_never_panic() {
    let database = database();
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    let mut read_some = 0;
    for round in 0..150 {
        let mut bytes = database.bytes.clone();
        for _ in 0..1 + numbers.below(20) {
            let at = if round % 3 == 0 { numbers.below(4096) } else { numbers.below(bytes.len()) };
            bytes[at] = numbers.below(256) as u8;
        }
        if round % 2 == 1 {
            bytes.truncate(numbers.below(bytes.len()));
        }
        std::fs::write(&database.file, &bytes).unwrap();
        if let Ok((recording, _)) = read(&database.file) {
            recording.validate().unwrap();
            read_some += 1;
        }
    }
    assert!(read_some > 50, "only {read_some} of 150 broken databases gave any data");
}
