//! Bags that we did not write: the practice cases, and the test files of rosbag2, the mcap crate and PlotJuggler.

#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use std::path::{Path, PathBuf};

use excavator_bags::{BagError, DamageKind, RawMessages, Topics, info, read_recording};
use excavator_model::recording::is_measured;
use support::shared;

#[test]
fn the_practice_bag_is_read() {
    let Some(bag) = shared("practice/p00/identification") else {
        return;
    };
    let (recording, report) = read_recording(&bag, &Topics::default()).unwrap();
    recording.validate().unwrap();
    assert_eq!((recording.len(), report.messages["/arm/orifice_command"]), (18_983, 19_000));
    assert!((recording.duration() - 37.998).abs() < 1e-3, "{}", recording.duration());
    assert!((recording.sample_interval() - 0.002).abs() < 1e-4);
    let arm = recording.cylinder("arm").unwrap();
    assert!(is_measured(&arm.displacement) && is_measured(&arm.orifice_command) && !is_measured(&arm.velocity));
    // 0.1 % of the state messages are lost: 17 of 19 000, two of them perhaps at the ends or next to each other.
    assert!((14..=17).contains(&report.gaps.len()), "{}", report.gaps.len());
    assert!(report.damage.is_empty() && report.duplicates == 0 && report.missing_messages == 0);
    assert_eq!(info(&bag).unwrap().problems, Vec::<String>::new());
}

#[test]
fn every_mcap_bag_of_rosbag2_opens_except_the_wrong_format() {
    let Some(root) = shared("realdata/bags/rosbag2") else {
        return;
    };
    let mut opened = 0;
    for bag in folders_with("mcap", &root) {
        match info(&bag) {
            Err(error) => {
                assert!(bag.ends_with("wrong_rmw_test"), "{error}");
                assert!(
                    matches!(&error, BagError::UnsupportedSerialization { format, .. } if format == "wrong_format")
                );
            }
            Ok(found) => {
                assert!(!bag.ends_with("wrong_rmw_test"));
                assert_eq!(found.problems, Vec::<String>::new(), "{}", bag.display());
                opened += 1;
            }
        }
    }
    assert_eq!(opened, 11);
}

#[test]
fn a_split_bag_has_all_messages_that_its_metadata_promises() {
    let Some(bag) = shared("realdata/bags/rosbag2/rosbag2_py/test/resources/mcap/wbag") else {
        return;
    };
    let found = info(&bag).unwrap();
    assert_eq!((found.files.len(), found.message_count, found.topics.len()), (5, 6074, 8));
    let counted = found.topics.iter().find(|topic| topic.name == "EEE").unwrap();
    assert_eq!((counted.message_count, counted.type_name.as_str()), (804, "std_msgs/msg/String"));
    let error = read_recording(&bag, &Topics::default()).unwrap_err();
    assert!(error.to_string().ends_with("it has AAA, BBB, CCC, DDD, EEE, FFF, GGG, HHH"), "{error}");
}

#[test]
fn a_split_bag_without_metadata_is_read_in_name_order() {
    let Some(bag) = shared("realdata/bags/rosbag2/rosbag2_py/test/resources/mcap/reindex_test_bags/multiple_files")
    else {
        return;
    };
    let times: Vec<u64> = RawMessages::open(&bag).unwrap().map(|message| message.unwrap().log_time).collect();
    assert!(!times.is_empty() && times.is_sorted());
}

#[test]
fn sqlite_bags_are_refused_with_a_clear_error() {
    let Some(root) = shared("realdata/bags") else {
        return;
    };
    let bags = folders_with("db3", &root);
    assert!(bags.len() >= 12);
    for bag in bags {
        if folders_with("mcap", &bag).contains(&bag) {
            continue;
        }
        let text = info(&bag).unwrap_err().to_string();
        assert!(text.contains("SQLite3 storage is not supported yet"), "{text}");
    }
}

#[test]
fn the_files_of_the_mcap_crate_are_read_as_far_as_they_go() {
    let Some(root) = shared("realdata/bags/mcap_crate") else {
        return;
    };
    for name in ["compressed.mcap", "uncompressed.mcap"] {
        let found = info(&root.join(name)).unwrap();
        assert_eq!((found.message_count, found.problems.len()), (826, 0), "{name}");
    }
    for (name, must_be_cut) in [("chunk_not_closed.mcap", true), ("zstd_chunk_with_padding.mcap", false)] {
        let mut messages = RawMessages::open(&root.join(name)).unwrap();
        assert!(messages.by_ref().all(|message| message.is_ok()));
        let damage = messages.damage();
        assert!(!damage.is_empty(), "{name}");
        assert!(!damage.iter().any(|damage| matches!(damage.kind, DamageKind::BadChunk { .. })), "{name}: {damage:?}");
        assert_eq!(damage.iter().any(|damage| matches!(damage.kind, DamageKind::CutOff { .. })), must_be_cut, "{name}");
    }
}

/// Every folder below `root`, itself included, that directly holds a file with this extension.
fn folders_with(extension: &str, root: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut waiting = vec![root.to_path_buf()];
    while let Some(folder) = waiting.pop() {
        let mut holds = false;
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            holds |= path.extension().is_some_and(|found| found == extension);
            if path.is_dir() {
                waiting.push(path);
            }
        }
        if holds {
            found.push(folder);
        }
    }
    found
}
