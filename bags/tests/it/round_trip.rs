//! A recording that was written and read again is the same, bit for bit.

use crate::support::{assert_equal, mcap_file, recording, write_small_chunks};
use excavator_bags::{BagError, Topics, read_recording, write_recording};
use excavator_model::recording::Recording;
use rosbag2::{Compression, WriteOptions, info};

#[test]
fn every_compression_gives_the_recording_back() {
    let folder = tempfile::tempdir().unwrap();
    let original = recording(3000);
    for compression in [Compression::None, Compression::Lz4, Compression::Zstd] {
        let bag = folder.path().join(format!("{compression:?}"));
        let file = write_small_chunks(&bag, &original, compression);
        for path in [&bag, &file] {
            let (found, report) = read_recording(path, &Topics::default()).unwrap();
            assert_equal(&found, &original);
            assert_eq!(report.problems(), Vec::<String>::new());
            assert_eq!(report.messages["/arm/state"], 3000);
        }
    }
}

#[test]
fn a_split_bag_is_one_recording() {
    let folder = tempfile::tempdir().unwrap();
    let original = recording(3000);
    let span = (original.duration() * 1e9) as u64;
    let small = WriteOptions { chunk_size: 16 * 1024, ..WriteOptions::default() };
    let by_size = WriteOptions { most_file_bytes: Some(40_000), ..small.clone() };
    let by_length = WriteOptions { most_file_nanoseconds: Some(span / 11), ..small };
    for (name, options, least) in [("by_size", by_size, 3), ("by_length", by_length, 11)] {
        let bag = folder.path().join(name);
        write_recording(&bag, &original, &Topics::default(), &options).unwrap();
        let files: Vec<_> =
            (0..).map(|k| bag.join(format!("{name}_{k}.mcap"))).take_while(|path| path.exists()).collect();
        assert!(files.len() >= least && files.len() <= least + 20, "{name}: {} files", files.len());
        if let Some(most) = options.most_file_bytes {
            // The index and one more chunk come after the file has been found large enough.
            assert!(files.iter().all(|file| file.metadata().unwrap().len() < most + 30_000));
        }
        assert_equal(&read_recording(&bag, &Topics::default()).unwrap().0, &original);
        // A recorder that was killed leaves no metadata.
        std::fs::remove_file(bag.join("metadata.yaml")).unwrap();
        assert_equal(&read_recording(&bag, &Topics::default()).unwrap().0, &original);
    }
}

#[test]
fn other_topic_names_are_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let topics = Topics { state: "/rig/state".into(), command: "/rig/command".into() };
    let original = recording(100);
    write_recording(&bag, &original, &topics, &WriteOptions::default()).unwrap();
    assert_equal(&read_recording(&bag, &topics).unwrap().0, &original);
    let error = read_recording(&bag, &Topics::default()).unwrap_err();
    assert!(matches!(&error, BagError::NoTopic { existing, .. } if existing.len() == 2), "{error}");
}

#[test]
fn an_existing_folder_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    std::fs::create_dir(&bag).unwrap();
    let error = write_recording(&bag, &recording(3), &Topics::default(), &WriteOptions::default()).unwrap_err();
    assert!(matches!(error, BagError::Bag(rosbag2::Error::AlreadyExists { .. })), "{error}");
    assert_eq!(std::fs::read_dir(&bag).unwrap().count(), 0);
}

#[test]
fn missing_parent_folders_are_made() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("of/today/bag");
    write_recording(&bag, &recording(3), &Topics::default(), &WriteOptions::default()).unwrap();
    assert!(mcap_file(&bag).is_file());
}

#[test]
fn stamps_that_a_bag_cannot_hold_are_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let write = |recording: &Recording| {
        write_recording(&bag, recording, &Topics::default(), &WriteOptions::default()).unwrap_err()
    };
    let mut early = recording(3);
    early.start_nanoseconds = -1;
    assert!(matches!(write(&early), BagError::StampOutOfRange { index: 0, nanoseconds: -1 }));
    let mut dense = recording(3);
    dense.time[2] = dense.time[1] + 1e-10;
    assert!(matches!(write(&dense), BagError::StampsCoincide { index: 2, .. }));
    let mut uneven = recording(3);
    uneven.pump_flow.pop();
    assert!(matches!(write(&uneven), BagError::InvalidRecording(_)));
    assert!(!bag.exists());
}

#[test]
fn info_counts_what_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let original = recording(501);
    write_recording(&bag, &original, &Topics::default(), &WriteOptions::default()).unwrap();
    let found = info(&bag).unwrap();
    assert_eq!(found.problems, Vec::<String>::new());
    assert!((found.duration - original.duration()).abs() < 1e-9);
    assert_eq!(found.size, std::fs::metadata(mcap_file(&bag)).unwrap().len());
    let names: Vec<&str> = found.topics.iter().map(|topic| topic.name.as_str()).collect();
    assert_eq!(names, ["/arm/orifice_command", "/arm/state"]);
    assert_eq!(found.topics[1].type_name, "excavator_msgs/msg/ArmState");
    assert_eq!(found.topics[1].message_count, 501);
    assert!((found.topics[1].mean_rate().unwrap() - 500.0).abs() < 1.0);
}

#[test]
fn the_library_that_wrote_the_format_finds_nothing_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let file = write_small_chunks(&folder.path().join("bag"), &recording(1000), Compression::Zstd);
    let bytes = std::fs::read(file).unwrap();
    let states = mcap::MessageStream::new(&bytes)
        .unwrap()
        .filter(|message| message.as_ref().unwrap().channel.topic == "/arm/state")
        .count();
    assert_eq!(states, 1000);
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert!(summary.chunk_indexes.len() > 5);
    for channel in summary.channels.values() {
        assert!(channel.metadata["offered_qos_profiles"].contains("reliability: reliable"));
        assert_eq!(channel.schema.as_ref().unwrap().encoding, "ros2msg");
    }
}
