//! Copies with fewer topics.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use excavator_store::{Options, thin_copy};
use mcap::records::{MessageHeader, Metadata};
use mcap::{MessageStream, WriteOptions};

/// A bag with an image on one topic for every ten small messages on another, in chunks of their own.
fn write(path: &Path, options: WriteOptions) {
    let mut writer =
        options.profile("ros2").chunk_size(Some(100_000)).create(BufWriter::new(File::create(path).unwrap())).unwrap();
    let schema = writer.add_schema("test/msg/Numbers", "ros2msg", b"float64[] values").unwrap();
    let nothing = BTreeMap::new();
    let small = writer.add_channel(schema, "/arm/state", "cdr", &nothing).unwrap();
    let large = writer.add_channel(schema, "/camera", "cdr", &nothing).unwrap();
    writer
        .write_metadata(&Metadata { name: "rosbag2".into(), metadata: BTreeMap::from([("a".into(), "b".into())]) })
        .unwrap();
    for number in 0..300_u32 {
        let is_image = (number / 10) % 10 != 0;
        let header = MessageHeader {
            channel_id: if is_image { large } else { small },
            sequence: number,
            log_time: u64::from(number),
            publish_time: u64::from(number),
        };
        // Not to be packed to nothing.
        let mut state = u64::from(number);
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 56) as u8
        };
        let content: Vec<u8> = (0..if is_image { 40_000 } else { 100 }).map(|_| noise()).collect();
        writer.write_to_known_channel(&header, &content).unwrap();
    }
    writer.finish().unwrap();
}

/// Topic, sequence, time and content of the messages of a topic.
fn messages(path: &Path, topic: &str) -> Vec<(u32, u64, Vec<u8>)> {
    let bytes = std::fs::read(path).unwrap();
    let all = MessageStream::new(&bytes).unwrap().map(Result::unwrap);
    all.filter(|one| one.channel.topic == topic).map(|one| (one.sequence, one.log_time, one.data.to_vec())).collect()
}

fn copied(bag: &Path, topics: &[&str]) -> (tempfile::TempDir, excavator_store::ThinCopy) {
    let folder = tempfile::tempdir().unwrap();
    let topics: Vec<String> = topics.iter().map(ToString::to_string).collect();
    let done = thin_copy(&bag.display().to_string(), Some(&topics), folder.path(), &Options::new()).unwrap();
    (folder, done)
}

#[test]
fn only_chunks_with_wanted_topics_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag.mcap");
    write(&bag, WriteOptions::new());
    for topics in [&["/arm/state"][..], &["*/state", "/nothing"]] {
        let (_kept, done) = copied(&bag, topics);
        assert!(done.whole.is_empty(), "{:?}", done.whole);
        assert_eq!(done.messages, 30);
        assert_eq!(done.bytes_total, std::fs::metadata(&bag).unwrap().len());
        assert!(done.bytes_read < done.bytes_total / 3, "{} of {}", done.bytes_read, done.bytes_total);
        assert_eq!(messages(&done.path, "/arm/state"), messages(&bag, "/arm/state"));
        assert!(messages(&done.path, "/camera").is_empty());
    }
}

#[test]
fn a_folder_is_copied_file_by_file() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    std::fs::create_dir(&bag).unwrap();
    write(&bag.join("bag_0.mcap"), WriteOptions::new());
    write(&bag.join("bag_1.mcap"), WriteOptions::new());
    std::fs::write(bag.join("metadata.yaml"), "rosbag2_bagfile_information:").unwrap();
    std::fs::write(bag.join("video.mp4"), "not for us").unwrap();
    let (_kept, done) = copied(&bag, &["/arm/state"]);
    assert_eq!(done.messages, 60);
    let mut names: Vec<_> = std::fs::read_dir(&done.path).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["bag_0.mcap", "bag_1.mcap", "metadata.yaml"]);
}

#[test]
fn what_cannot_be_copied_thinly_is_copied_whole() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag.mcap");
    let same = |reason: &str, topics: &[&str]| {
        let (_kept, done) = copied(&bag, topics);
        assert_eq!(done.whole, [format!("bag.mcap: {reason}")]);
        assert_eq!(std::fs::read(&done.path).unwrap(), std::fs::read(&bag).unwrap());
    };
    write(&bag, WriteOptions::new());
    same("every topic is wanted", &["*"]);
    let mut bytes = std::fs::read(&bag).unwrap();
    bytes[2_000] ^= 1;
    std::fs::write(&bag, &bytes).unwrap();
    same("a damaged chunk", &["/arm/state"]);
    bytes.truncate(bytes.len() - 100);
    std::fs::write(&bag, &bytes).unwrap();
    same("no index", &["/arm/state"]);
    write(&bag, WriteOptions::new().use_chunks(false));
    same("records outside chunks", &["/arm/state"]);
}

#[test]
fn a_small_bag_is_read_once() {
    let bag = Path::new(env!("CARGO_MANIFEST_DIR")).join("../bags/samples/arm-swing/arm-swing_0.mcap");
    let (_kept, done) = copied(&bag, &["/arm/state"]);
    assert!(done.whole.is_empty() && done.messages > 0, "{done:?}");
    assert_eq!(done.bytes_read, done.bytes_total);
    assert_eq!(messages(&done.path, "/arm/state"), messages(&bag, "/arm/state"));
}
