//! Bags that rosbag2 compressed stay compressed when they are reindexed, and their metadata says how.

use std::path::{Path, PathBuf};

use rosbag2::{BagCompression, BagWriter, Error, RawMessages, Reindexed, TopicToWrite, WriteOptions, cdr, reindex};

/// So many numbers on `/a`, one each millisecond, in files of 100 ms; each compressed by itself where `packs` says so.
fn write(bag: &Path, count: u64, packs: impl Fn(u64) -> bool) {
    let options = WriteOptions { most_file_nanoseconds: Some(100_000_000), ..WriteOptions::default() };
    let mut writer = BagWriter::create(bag, &options).unwrap();
    let topic = TopicToWrite {
        name: "/a".into(),
        type_name: "std_msgs/msg/Float64".into(),
        schema: "float64 data".into(),
        qos: Vec::new(),
    };
    let a = writer.add_topic(&topic).unwrap();
    for index in 0..count {
        let bytes = cdr::encode(&(index as f64)).unwrap();
        let bytes = if packs(index) { zstd::encode_all(&bytes[..], 1).unwrap() } else { bytes };
        writer.write(a, index * 1_000_000, index * 1_000_000, &bytes).unwrap();
    }
    writer.finish().unwrap();
    std::fs::remove_file(bag.join("metadata.yaml")).unwrap();
}

fn pack(file: &Path) -> PathBuf {
    let packed = PathBuf::from(format!("{}.zstd", file.display()));
    std::fs::write(&packed, zstd::encode_all(&std::fs::read(file).unwrap()[..], 1).unwrap()).unwrap();
    std::fs::remove_file(file).unwrap();
    packed
}

fn values(bag: &Path) -> Vec<f64> {
    RawMessages::open(bag).unwrap().map(|message| cdr::decode(&message.unwrap().data).unwrap()).collect()
}

/// The two lines of the metadata about compression.
fn words(done: &Reindexed) -> Vec<String> {
    let text = std::fs::read_to_string(done.metadata.as_ref().unwrap()).unwrap();
    let lines = text.lines().map(str::trim).filter(|line| line.starts_with("compression_"));
    lines.map(ToString::to_string).collect()
}

fn expected(count: u64) -> Vec<f64> {
    (0..count).map(|index| index as f64).collect()
}

#[test]
fn the_mode_is_that_of_the_files() {
    let folder = tempfile::tempdir().unwrap();
    for (name, mode, compression) in [
        ("none", ["compression_format: \"\"", "compression_mode: \"\""], BagCompression::None),
        ("message", ["compression_format: zstd", "compression_mode: MESSAGE"], BagCompression::Message),
        ("file", ["compression_format: zstd", "compression_mode: FILE"], BagCompression::File),
    ] {
        let bag = folder.path().join(name);
        write(&bag, 250, |_| compression == BagCompression::Message);
        if compression == BagCompression::File {
            (0..3).for_each(|number| drop(pack(&bag.join(format!("file_{number}.mcap")))));
        }
        let done = reindex(&bag, false).unwrap();
        assert_eq!((done.compression, words(&done)), (compression, mode.map(String::from).to_vec()), "{name}");
        assert!(done.files.iter().all(|file| !file.rewritten && file.damage.is_empty()), "{name}");
        assert_eq!(values(&bag), expected(250), "{name}");
    }
}

#[test]
fn the_last_file_of_a_killed_recorder_is_compressed_as_the_others_are() {
    let folder = tempfile::tempdir().unwrap();
    for keep in [false, true] {
        let bag = folder.path().join(if keep { "kept" } else { "bag" });
        write(&bag, 250, |_| false);
        let name = bag.file_name().unwrap().to_string_lossy().into_owned();
        (0..2).for_each(|number| drop(pack(&bag.join(format!("{name}_{number}.mcap")))));
        // Not closed: its index and its end are missing.
        let last = bag.join(format!("{name}_2.mcap"));
        let bytes = std::fs::read(&last).unwrap();
        std::fs::write(&last, &bytes[..bytes.len() - 200]).unwrap();
        let done = reindex(&bag, keep).unwrap();
        assert_eq!(done.compression, BagCompression::File);
        assert!(done.files[2].rewritten && done.files[2].packed && !last.exists());
        assert_eq!(done.files[2].original.as_ref().is_some_and(|original| original.exists()), keep);
        assert_eq!(values(&bag), expected(250));
        assert_eq!(reindex(&bag, keep).unwrap().files.iter().filter(|file| file.rewritten || file.packed).count(), 0);
    }
}

#[test]
fn a_compressed_file_that_is_cut_is_written_anew_compressed() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    write(&bag, 100, |_| false);
    let file = bag.join("bag_0.mcap");
    let bytes = std::fs::read(&file).unwrap();
    std::fs::write(&file, &bytes[..bytes.len() - 200]).unwrap();
    let packed = pack(&file);
    let done = reindex(&bag, true).unwrap();
    assert!(done.files[0].rewritten && done.files[0].path == packed);
    assert_eq!((done.compression, values(&bag)), (BagCompression::File, expected(100)));
}

#[test]
fn messages_that_are_compressed_in_part_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    write(&bag, 100, |index| index < 30);
    let error = reindex(&bag, false).unwrap_err();
    assert!(matches!(error, Error::MixedCompression { compressed: 30, messages: 100, .. }), "{error}");
}

#[test]
fn compressed_messages_that_are_broken_are_left_out_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    write(&bag, 100, |_| true);
    let file = bag.join("bag_0.mcap");
    let mut writer = BagWriter::create(&folder.path().join("broken"), &WriteOptions::default()).unwrap();
    let schema = "float64 data".to_string();
    let (name, type_name) = ("/a".to_string(), "std_msgs/msg/Float64".to_string());
    let a = writer.add_topic(&TopicToWrite { name, type_name, schema, qos: Vec::new() }).unwrap();
    for index in 0..100_u64 {
        let bytes = zstd::encode_all(&cdr::encode(&(index as f64)).unwrap()[..], 1).unwrap();
        let length = if index % 10 == 3 { bytes.len() / 2 } else { bytes.len() };
        writer.write(a, index, index, &bytes[..length]).unwrap();
    }
    writer.finish().unwrap();
    std::fs::copy(folder.path().join("broken/broken_0.mcap"), &file).unwrap();
    let done = reindex(&bag, false).unwrap();
    assert!(done.files[0].rewritten && done.files[0].damage.len() == 1, "{:?}", done.files[0]);
    assert_eq!((done.messages(), values(&bag).len()), (90, 90));
    assert!(RawMessages::open(&bag).unwrap().damage().is_empty());
}
