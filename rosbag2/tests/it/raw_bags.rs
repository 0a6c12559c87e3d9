//! Messages of any type as bytes: into a bag and back, in several files, after a cut, and into the place of an older bag.

use std::path::Path;

use rosbag2::{
    BagWriter, DamageKind, Error, Qos, RawMessages, Staging, TopicToWrite, WriteOptions, cdr, info, reindex,
};

fn topic(name: &str) -> TopicToWrite {
    TopicToWrite {
        name: name.into(),
        type_name: "std_msgs/msg/Float64".into(),
        schema: "float64 data".into(),
        qos: vec![Qos::reliable(5)],
    }
}

/// So many messages on `/a`, one each millisecond, and none on `/silent`.
fn write(bag: &Path, count: u64, options: &WriteOptions) -> Result<(), Error> {
    let mut writer = BagWriter::create(bag, options)?;
    let a = writer.add_topic(&topic("/a"))?;
    writer.add_topic(&topic("/silent"))?;
    for index in 0..count {
        writer.write(a, index * 1_000_000, index * 1_000_000, &cdr::encode(&(index as f64)).unwrap())?;
    }
    writer.finish().map(drop)
}

fn values(bag: &Path) -> Vec<f64> {
    RawMessages::open(bag).unwrap().map(|message| cdr::decode(&message.unwrap().data).unwrap()).collect()
}

#[test]
fn what_was_written_into_several_files_is_read_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let options = WriteOptions { most_file_nanoseconds: Some(100_000_000), ..WriteOptions::default() };
    write(&bag, 350, &options).unwrap();
    assert_eq!(values(&bag), (0..350).map(f64::from).collect::<Vec<_>>());
    let found = info(&bag).unwrap();
    assert_eq!((found.files.len(), found.message_count, found.problems.len()), (4, 350, 0));
    let topics: Vec<(&str, u64)> =
        found.topics.iter().map(|topic| (topic.name.as_str(), topic.message_count)).collect();
    assert_eq!(topics, [("/a", 350), ("/silent", 0)]);
    let known = RawMessages::open(&bag).unwrap().topics();
    assert_eq!((known[0].type_name.as_str(), known[0].qos()), ("std_msgs/msg/Float64", vec![Qos::reliable(5)]));
}

#[test]
fn a_file_that_was_cut_is_whole_after_a_reindex() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    write(&bag, 2000, &WriteOptions { chunk_size: 4096, ..WriteOptions::default() }).unwrap();
    let file = bag.join("bag_0.mcap");
    let bytes = std::fs::read(&file).unwrap();
    std::fs::write(&file, &bytes[..bytes.len() / 2]).unwrap();
    let mut messages = RawMessages::open(&bag).unwrap();
    let count = messages.by_ref().filter(Result::is_ok).count() as u64;
    let damage = messages.damage();
    assert!(count > 100 && count < 2000, "{count}");
    assert!(matches!(damage[0].kind, DamageKind::CutOff { .. } | DamageKind::NotClosed), "{}", damage[0]);
    let done = reindex(&bag, true).unwrap();
    assert_eq!((done.messages(), done.files[0].rewritten), (count, true));
    assert_eq!(done.files[0].original.as_deref(), Some(bag.join("bag_0.mcap.damaged").as_path()));
    assert_eq!(info(&bag).unwrap().problems, Vec::<String>::new());
    assert_eq!(values(&bag).len() as u64, count);
}

#[test]
fn a_bag_is_replaced_as_a_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    write(&bag, 3, &WriteOptions::default()).unwrap();
    assert!(matches!(Staging::beside(&bag, false), Err(Error::AlreadyExists { .. })));
    let staging = Staging::beside(&bag, true).unwrap();
    write(staging.folder(), 5, &WriteOptions::default()).unwrap();
    assert_eq!(values(&bag).len(), 3);
    staging.put_in_place().unwrap();
    assert_eq!(values(&bag).len(), 5);
}

#[cfg(not(feature = "sqlite"))]
#[test]
fn a_sqlite_bag_says_which_feature_it_needs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bag.db3");
    std::fs::write(&file, b"SQLite format 3\0 and more").unwrap();
    let refused = RawMessages::open(&file).unwrap_err().to_string();
    assert!(refused.ends_with("bag.db3: reading SQLite3 needs a build with the feature `sqlite`"), "{refused}");
}
