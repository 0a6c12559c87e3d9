//! Bags that we did not write: the practice cases, and the test files of rosbag2, the mcap crate and PlotJuggler.

use crate::support::shared;
use excavator_bags::{Topics, read_recording};
use excavator_model::recording::is_measured;
use rosbag2::{DamageKind, RawMessages, info};

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
