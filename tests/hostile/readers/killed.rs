//! Bags whose recorder was killed.

use std::path::{Path, PathBuf};
use std::process::Command;

use excavator_bags::topic_to_write;
use excavator_msgs::ArmState;
use rosbag2::{BagWriter, Qos, RawMessages, WriteOptions, cdr};

use crate::hostile::child::run;
use crate::hostile::fault::Fault;
use crate::live::{Network, until};

/// An interpreter that has the libraries of others, or `None` with a line that says what is skipped.
fn python() -> Option<PathBuf> {
    let path = std::env::var_os("EXCAVATOR_PYTHON")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../.venv/bin/python"), PathBuf::from);
    let has = Command::new(&path).args(["-c", "import rosbags, mcap"]).output().is_ok_and(|o| o.status.success());
    if !has {
        println!("skipped: {} has no rosbags and mcap (set EXCAVATOR_PYTHON)", path.display());
    }
    has.then_some(path)
}

/// Messages that rosbags sees in the folder and the index that mcap sees in each file; `Err` with what they say.
fn others_see(python: &Path, bag: &Path) -> Result<u64, String> {
    const SCRIPT: &str = "
import sys
from pathlib import Path
from rosbags.rosbag2 import Reader
from mcap.reader import make_reader
folder = Path(sys.argv[1])
with Reader(folder) as reader:
    count = sum(1 for _ in reader.messages())
    assert count == reader.message_count, (count, reader.message_count)
indexed = 0
for file in sorted(folder.glob('*.mcap')):
    with file.open('rb') as stream:
        summary = make_reader(stream, validate_crcs=True).get_summary()
        assert summary is not None and summary.statistics is not None, file
        indexed += summary.statistics.message_count
assert indexed in (0, count), (indexed, count)
print(count)
";
    let output = Command::new(python).args(["-c", SCRIPT]).arg(bag).output().unwrap();
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().parse().unwrap())
}

/// Readable messages, their bytes added up.
fn ours(bag: &Path) -> (u64, u64) {
    let mut seen = (0, 0);
    for message in RawMessages::open(bag).unwrap() {
        let message = message.unwrap();
        seen.0 += 1;
        seen.1 += message.data.iter().map(|&byte| u64::from(byte)).sum::<u64>() + message.log_time % 1000;
    }
    seen
}

fn state(index: u64) -> Vec<u8> {
    let mut state = ArmState {
        header: excavator_msgs::Header::default(),
        cylinders: vec![excavator_msgs::CylinderState::unmeasured("arm")],
        pump_pressure: index as f64,
        tank_pressure: (index as f64).sin(),
        pump_flow: 3.0,
        oil_temperature: 4.0,
    };
    state.header.stamp = excavator_msgs::Time::from_nanoseconds(index as i64 * 2_000_000).unwrap();
    cdr::encode(&state).unwrap()
}

/// A bag of several files, as a writer leaves it that ended.
fn bag(folder: &Path) -> PathBuf {
    let path = folder.join("bag");
    let options = WriteOptions { chunk_size: 20_000, most_file_bytes: Some(100_000), ..WriteOptions::default() };
    let mut writer = BagWriter::create(&path, &options).unwrap();
    let topic = writer.add_topic(&topic_to_write::<ArmState>("/arm/state", Qos::reliable(10))).unwrap();
    writer.add_topic(&topic_to_write::<excavator_msgs::OrificeCommand>("/silent", Qos::reliable(10))).unwrap();
    for index in 0..20_000 {
        writer
            .write(topic, 1_000_000_000 + index * 2_000_000, 1_000_000_000 + index * 2_000_000, &state(index))
            .unwrap();
    }
    writer.set_custom_data("operator", "Ada");
    writer.finish().unwrap();
    path
}

fn last_file(bag: &Path) -> PathBuf {
    let count =
        std::fs::read_dir(bag).unwrap().filter(|e| e.as_ref().unwrap().path().extension().unwrap() == "mcap").count();
    bag.join(format!("bag_{}.mcap", count - 1))
}

#[test]
fn a_bag_cut_anywhere_is_readable_for_others_after_reindex() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let whole = bag(folder.path());
    let (all, _) = ours(&whole);
    let length = std::fs::metadata(last_file(&whole)).unwrap().len();
    let mut least = all;
    for cut in [10, 30, 200, length / 3, length / 2, length - 40] {
        let copy = folder.path().join("copy");
        let _ = std::fs::remove_dir_all(&copy);
        std::fs::create_dir(&copy).unwrap();
        for entry in std::fs::read_dir(&whole).unwrap() {
            let path = entry.unwrap().path();
            std::fs::copy(&path, copy.join(path.file_name().unwrap())).unwrap();
        }
        std::fs::remove_file(copy.join("metadata.yaml")).unwrap();
        let last = last_file(&copy);
        std::fs::OpenOptions::new().write(true).open(&last).unwrap().set_len(length - cut).unwrap();
        assert!(others_see(&python, &copy).is_err(), "others can read what was cut by {cut}");
        let before = ours(&copy);
        let done = run(folder.path(), &["reindex", "copy"], 30.0);
        assert_eq!(done.status, Some(0), "{done:?}");
        assert!(done.output.contains(&format!("{} messages in 2 topics", before.0)), "{done:?}");
        assert!(done.output.contains("left as it is") && done.output.contains("rewritten with"), "{done:?}");
        assert_eq!(others_see(&python, &copy), Ok(before.0));
        assert_eq!(ours(&copy), before, "cut by {cut}");
        assert!(RawMessages::open(&copy).unwrap().damage().is_empty());
        // Nothing is left beside, and the second time there is nothing to do.
        assert_eq!(std::fs::read_dir(&copy).unwrap().count(), std::fs::read_dir(&whole).unwrap().count());
        let again = run(folder.path(), &["reindex", "copy"], 30.0);
        assert!(again.status == Some(0) && !again.output.contains("anew"), "{again:?}");
        least = least.min(before.0);
    }
    Fault {
        group: "Recorder",
        tried: "a bag cut in the footer, the index or a record, without metadata",
        outcome: "excavator reindex makes it readable for rosbags and mcap, with every message that was readable",
    }
    .survived(&[("messages whole", all.to_string()), ("messages in the shortest", least.to_string())]);
}

#[test]
fn bare_files_databases_and_notes_in_the_metadata_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let whole = bag(folder.path());
    // The metadata's own notes survive; a file that it does not list is found.
    let metadata = whole.join("metadata.yaml");
    let done = run(folder.path(), &["reindex", "bag"], 30.0);
    assert_eq!(done.status, Some(0), "{done:?}");
    assert!(
        std::fs::read_to_string(&metadata).unwrap().contains("operator: Ada"),
        "{}",
        std::fs::read_to_string(&metadata).unwrap()
    );
    // A bare file.
    let bare = folder.path().join("bare.mcap");
    std::fs::copy(whole.join("bag_0.mcap"), &bare).unwrap();
    let length = std::fs::metadata(&bare).unwrap().len();
    std::fs::OpenOptions::new().write(true).open(&bare).unwrap().set_len(length - 100).unwrap();
    let before = ours(&bare);
    let done = run(folder.path(), &["reindex", "bare.mcap", "--keep"], 30.0);
    assert_eq!(done.status, Some(0), "{done:?}");
    assert_eq!(ours(&bare), before);
    assert_eq!(std::fs::metadata(folder.path().join("bare.mcap.damaged")).unwrap().len(), length - 100);
    // A database without metadata.
    let sqlite = folder.path().join("sqlite");
    std::fs::create_dir(&sqlite).unwrap();
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../bags/samples/joint-states/joint-states.db3");
    std::fs::copy(sample, sqlite.join("joint-states.db3")).unwrap();
    let before = ours(&sqlite);
    let done = run(folder.path(), &["reindex", "sqlite"], 30.0);
    assert_eq!(done.status, Some(0), "{done:?}");
    assert_eq!(ours(&sqlite), before);
    if let Some(python) = python() {
        assert_eq!(others_see(&python, &sqlite), Ok(before.0));
    }
    // Nothing to win.
    std::fs::write(folder.path().join("no.mcap"), "nothing").unwrap();
    let refused = run(folder.path(), &["reindex", "no.mcap"], 10.0);
    refused.refused(&["is not a bag", "7 bytes"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("no.mcap")).unwrap(), "nothing");
}

#[test]
fn a_recorder_killed_under_load() {
    let (Some(python), Some(network)) = (python(), Network::new("reindex")) else { return };
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let _simulator = network.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=1000"]);
    let recorder = network.start(&["record", "--all", "-o", bag.to_str().unwrap()]);
    // Two hundred kilobytes are several chunks, written while messages come.
    let file = bag.join("bag_0.mcap");
    until("200 kB of recording", || std::fs::metadata(&file).is_ok_and(|metadata| metadata.len() > 200_000));
    recorder.kill();
    assert!(!bag.join("metadata.yaml").exists());
    assert!(others_see(&python, &bag).is_err());
    let before = ours(&bag);
    let done = run(folder.path(), &["reindex", "bag"], 30.0);
    assert_eq!(done.status, Some(0), "{done:?}");
    assert_eq!(others_see(&python, &bag), Ok(before.0));
    assert_eq!(ours(&bag), before);
    assert!(before.0 > 500, "{before:?}");
    Fault {
        group: "Recorder",
        tried: "the recorder is killed under load",
        outcome: "after excavator reindex, rosbags and mcap read every message that reached the disk",
    }
    .survived(&[("messages", before.0.to_string()), ("time of reindex [s]", format!("{:.2}", done.seconds))]);
}
