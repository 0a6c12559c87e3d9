//! One recording in every storage and compression that others write: rosbags writes, we read, all the same.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::assert_equal;
use excavator_bags::map::{TopicMap, read_mapped};
use excavator_bags::{Topics, read_recording};
use rosbag2::RawMessages;

/// An interpreter that has rosbags, or `None` with a line that says what is skipped.
fn python() -> Option<PathBuf> {
    let python = match std::env::var_os("EXCAVATOR_PYTHON") {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../.venv/bin/python"),
    };
    let found = Command::new(&python).args(["-c", "import rosbags"]).output().is_ok_and(|out| out.status.success());
    if !found {
        eprintln!("skipped: {} has no rosbags (set EXCAVATOR_PYTHON to an interpreter that has)", python.display());
    }
    found.then_some(python)
}

#[test]
fn every_storage_and_compression_gives_the_same_messages_and_recording() {
    let Some(python) = python() else { return };
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples");
    let folder = tempfile::tempdir().unwrap();
    let map = TopicMap::read(&samples.join("joint-states/map.toml")).unwrap();
    let mut first = None;
    for kind in ["sqlite3", "sqlite3-file", "sqlite3-message", "mcap", "mcap-file", "mcap-message"] {
        let bag = folder.path().join(kind);
        let arguments = [Path::new("make.py"), Path::new("bag"), Path::new("arm-swing"), &bag, Path::new(kind)];
        let output = Command::new(&python).args(arguments).current_dir(&samples).output().unwrap();
        assert!(output.status.success(), "{kind}: {}", String::from_utf8_lossy(&output.stderr));
        let mut messages: Vec<(String, String, u64, Vec<u8>)> = RawMessages::open(&bag)
            .unwrap()
            .map(Result::unwrap)
            .map(|m| (m.topic.name.clone(), m.topic.type_name.clone(), m.log_time, m.data.to_vec()))
            .collect();
        messages.sort();
        let (recording, report) = read_mapped(&bag, &map).unwrap();
        assert_eq!(report.problems(), Vec::<String>::new(), "{kind}");
        let (expected_messages, expected) = first.get_or_insert_with(|| (messages.clone(), recording.clone()));
        assert!(messages == *expected_messages, "{kind}: other messages than in sqlite3");
        assert_equal(&recording, expected);
    }
    let (original, _) = read_recording(&samples.join("arm-swing"), &Topics::default()).unwrap();
    assert_eq!(first.unwrap().1.time, original.time);
}
