//! Every bag of the shared folder `realdata/bags`, one by one: what its README says must open opens whole, what must be
//! refused is refused, and a bag in two storages has the same messages in both.

use std::path::{Path, PathBuf};

use rosbag2::{RawMessages, info};

/// The folder of other people's files, or `None` with a line that says what is skipped.
fn shared(what: &str) -> Option<PathBuf> {
    let root = match std::env::var_os("EXCAVATOR_SHARED") {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
    };
    let path = root.join(what);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: {} does not exist (set EXCAVATOR_SHARED to the folder of shared files)", path.display());
    None
}

/// Everything below `root` for which `wanted` holds, sorted.
fn below(root: &Path, wanted: impl Fn(&Path) -> bool) -> Vec<PathBuf> {
    let (mut found, mut waiting) = (Vec::new(), vec![root.to_path_buf()]);
    while let Some(folder) = waiting.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                waiting.push(path.clone());
            }
            if wanted(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn is_bag_file(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "mcap" || extension == "db3")
}

fn holds_bag_files(path: &Path) -> bool {
    path.is_dir() && std::fs::read_dir(path).unwrap().any(|entry| is_bag_file(&entry.unwrap().path()))
}

/// Topic, type, log time and bytes of every message, sorted by time and topic: writers order equal times as they like.
fn messages(bag: &Path) -> Vec<(u64, String, String, Vec<u8>)> {
    let mut messages: Vec<_> = RawMessages::open(bag)
        .unwrap()
        .map(|message| message.unwrap())
        .map(|message| {
            (message.log_time, message.topic.name.clone(), message.topic.type_name.clone(), message.data.to_vec())
        })
        .collect();
    messages.sort();
    messages
}

#[test]
fn every_folder_of_rosbag2_opens_whole_except_those_in_a_wrong_format() {
    let Some(root) = shared("realdata/bags/rosbag2") else { return };
    let folders = below(&root, |path| holds_bag_files(path) && !path.ends_with("rosbag2_cpp/bags"));
    let (mut opened, mut refused) = (0, 0);
    for folder in &folders {
        let name = folder.strip_prefix(&root).unwrap().display();
        match info(folder) {
            Err(rosbag2::Error::UnsupportedSerialization { format, .. }) if folder.ends_with("wrong_rmw_test") => {
                assert_eq!(format, "wrong_format", "{name}");
                refused += 1;
            }
            Err(error) => panic!("{name}: {error}"),
            Ok(found) => {
                // A count other than that of metadata.yaml is a problem too.
                assert_eq!(found.problems, Vec::<String>::new(), "{name}");
                assert!(!folder.ends_with("wrong_rmw_test"));
                let has_messages = found.message_count > 0;
                assert_eq!(has_messages, !folder.ends_with("empty_bag"), "{name}");
                println!("{name}: {} messages, {} topics", found.message_count, found.topics.len());
                opened += 1;
            }
        }
    }
    println!("{opened} folders opened, {refused} refused");
    assert_eq!((opened, refused), (folders.len() - 2, 2));
    assert!(opened >= 20);
}

#[test]
fn every_single_file_opens_without_its_metadata() {
    let Some(root) = shared("realdata/bags/rosbag2") else { return };
    let files = below(&root, is_bag_file);
    assert!(files.len() >= 38, "{}", files.len());
    for file in files {
        let found = info(&file).unwrap();
        assert_eq!(found.problems, Vec::<String>::new(), "{}", file.display());
        assert_eq!(found.message_count > 0, !file.ends_with("empty_bag_0.db3"), "{}", file.display());
    }
}

#[test]
fn a_bag_in_two_storages_has_the_same_messages_in_both() {
    let Some(root) = shared("realdata/bags/rosbag2") else { return };
    let twins = [
        ("rosbag2_py/test/resources/{}/convert_a", 150),
        ("rosbag2_py/test/resources/{}/convert_b", 75),
        ("rosbag2_py/test/resources/{}/reindex_test_bags/multiple_files", 3177),
        ("rosbag2_py/test/resources/{}/wbag", 6074),
        ("rosbag2_tests/resources/{}/cdr_test", 7),
        ("rosbag2_transport/test/resources/{}/rewriter_a", 150),
        ("rosbag2_transport/test/resources/{}/rewriter_b", 75),
        ("rosbag2_transport/test/resources/{}/test_bag_for_seek", 5),
    ];
    for (folder, count) in twins {
        let [mcap, sqlite] = ["mcap", "sqlite3"].map(|storage| messages(&root.join(folder.replace("{}", storage))));
        assert_eq!(sqlite.len(), count, "{folder}");
        assert!(mcap == sqlite, "{folder}: the messages differ");
    }
}

#[test]
fn the_bag_of_plotjuggler_has_what_its_readme_says() {
    let Some(bag) = shared("realdata/bags/plotjuggler") else { return };
    let found = info(&bag).unwrap();
    assert_eq!(found.problems, Vec::<String>::new());
    assert!((found.duration - 62.56).abs() < 0.01, "{}", found.duration);
    for name in ["/imu", "/battery", "/pose"] {
        let topic = found.topics.iter().find(|topic| topic.name == name).unwrap();
        assert_eq!(topic.message_count, 1565, "{name}");
        assert!((topic.mean_rate().unwrap() - 25.0).abs() < 0.1, "{name}");
    }
}
