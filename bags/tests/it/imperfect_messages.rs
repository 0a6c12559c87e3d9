//! Messages out of order, twice, missing, half measured or of another kind.

use std::path::Path;

use crate::support::{add, command, state};
use excavator_bags::{BagError, Gap, ReadReport, Topics, read_recording, topic_to_write};
use excavator_model::recording::Recording;
use excavator_msgs::{ArmState, Message, OrificeCommand};
use rosbag2::{BagWriter, Qos, WriteOptions};

const STATE: &str = "/arm/state";
const COMMAND: &str = "/arm/orifice_command";

fn bag(write: impl FnOnce(&mut BagWriter)) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag");
    let mut writer = BagWriter::create(&path, &WriteOptions::default()).unwrap();
    write(&mut writer);
    writer.finish().unwrap();
    (folder, path)
}

fn read(write: impl FnOnce(&mut BagWriter)) -> (Recording, ReadReport) {
    let (_folder, path) = bag(write);
    let (recording, report) = read_recording(&path, &Topics::default()).unwrap();
    recording.validate().unwrap();
    (recording, report)
}

fn error(write: impl FnOnce(&mut BagWriter)) -> BagError {
    let (_folder, path) = bag(write);
    read_recording(&path, &Topics::default()).unwrap_err()
}

#[test]
fn stamps_are_sorted_and_duplicates_dropped() {
    let (recording, report) = read(|bag| {
        for stamp in [3_000_000, 1_000_000, 2_000_000, 3_000_000, 5_000_000, 4_000_000] {
            add(bag, STATE, &state(stamp, &["arm"]));
        }
    });
    assert_eq!(recording.start_nanoseconds, 1_000_000);
    assert_eq!(recording.time, [0.0, 0.001, 0.002, 0.003, 0.004]);
    assert_eq!(recording.cylinders[0].displacement, [1e6, 2e6, 3e6, 4e6, 5e6]);
    assert_eq!((report.reordered, report.duplicates), (3, 1));
}

#[test]
fn gaps_are_those_longer_than_one_and_a_half_intervals() {
    let (_, report) = read(|bag| {
        for stamp in [0, 1_000_000, 2_000_000, 3_400_000, 4_400_000, 6_000_000, 7_000_000] {
            add(bag, STATE, &state(stamp, &["arm"]));
        }
    });
    assert_eq!(report.gaps, [Gap { after: 0.0044, length: 0.006 - 0.0044 }]);
}

#[test]
fn a_cylinder_in_some_messages_is_not_measured_in_the_others() {
    let (recording, report) = read(|bag| {
        add(bag, STATE, &state(1, &["arm"]));
        add(bag, STATE, &state(2, &["boom", "arm"]));
        add(bag, STATE, &state(3, &["boom"]));
        add(bag, STATE, &state(4, &["arm", "arm"]));
    });
    let displacement = |name: &str| format!("{:?}", recording.cylinder(name).unwrap().displacement);
    assert_eq!(displacement("arm"), "[1.0, 2.0, NaN, 4.0]");
    assert_eq!(displacement("boom"), "[NaN, 2.0, 3.0, NaN]");
    assert_eq!(report.repeated_cylinders, 1);
}

#[test]
fn commands_are_held_from_their_own_stamp() {
    let (recording, report) = read(|bag| {
        for stamp in [10, 20, 30, 40, 50] {
            add(bag, STATE, &state(stamp, &["arm", "boom"]));
        }
        add(bag, COMMAND, &command(35, &["arm"], &[3.0]));
        add(bag, COMMAND, &command(20, &["arm", "boom"], &[1.0, 7.0]));
        add(bag, COMMAND, &command(41, &["arm", "bucket"], &[f64::INFINITY, 1.0]));
        add(bag, COMMAND, &command(42, &["arm"], &[]));
    });
    let held = |name: &str| format!("{:?}", recording.cylinder(name).unwrap().orifice_command);
    assert_eq!(held("arm"), "[NaN, 1.0, 1.0, 3.0, NaN]");
    assert_eq!(held("boom"), "[NaN, 7.0, 7.0, 7.0, 7.0]");
    assert_eq!((report.reordered_commands, report.malformed_commands, report.infinite_values), (1, 1, 1));
    assert_eq!(report.commands_without_cylinder, ["bucket"]);
}

#[test]
fn infinite_values_are_not_measurements() {
    let (recording, report) = read(|bag| {
        let mut broken = state(1, &["arm"]);
        broken.pump_flow = f64::NEG_INFINITY;
        broken.cylinders[0].rod_force = f64::INFINITY;
        add(bag, STATE, &broken);
    });
    assert!(recording.pump_flow[0].is_nan() && recording.cylinders[0].rod_force[0].is_nan());
    assert_eq!(report.infinite_values, 2);
}

#[test]
fn without_the_topic_of_states_those_that_exist_are_named() {
    let error = error(|bag| add(bag, COMMAND, &command(1, &[], &[])));
    assert!(error.to_string().ends_with("has no topic /arm/state; it has /arm/orifice_command"), "{error}");
}

#[test]
fn a_topic_without_messages_is_an_error_of_its_own() {
    let error = error(|bag| {
        bag.add_topic(&topic_to_write::<ArmState>(STATE, Qos::reliable(1))).unwrap();
        add(bag, COMMAND, &command(1, &[], &[]));
    });
    assert!(matches!(&error, BagError::NoMessages { damage, .. } if damage.is_empty()), "{error}");
}

#[test]
fn another_type_on_the_topic_is_an_error() {
    let error = error(|bag| add(bag, STATE, &command(1, &[], &[])));
    let BagError::WrongType { found, expected, .. } = &error else { panic!("{error}") };
    assert_eq!((found.as_str(), *expected), (OrificeCommand::TYPE_NAME, ArmState::TYPE_NAME));
}

#[test]
fn another_definition_of_the_type_is_an_error_that_names_the_field() {
    let error = error(|bag| {
        let mut topic = topic_to_write::<ArmState>(STATE, Qos::reliable(1));
        topic.schema = topic.schema.replace("float64 pump_flow", "float32 pump_flow");
        let id = bag.add_topic(&topic).unwrap();
        bag.write(id, 0, 0, &[0, 1, 0, 0]).unwrap();
    });
    let text = error.to_string();
    assert!(text.ends_with("it has \"float32 pump_flow\" where we have \"float64 pump_flow\""), "{text}");
}

#[test]
fn one_message_that_cannot_be_decoded_is_left_out_and_all_are_an_error() {
    let broken = |bag: &mut BagWriter| {
        let id = bag.add_topic(&topic_to_write::<ArmState>(STATE, Qos::reliable(1))).unwrap();
        bag.write(id, 0, 0, &[0, 1, 0, 0, 1, 2, 3]).unwrap();
    };
    let (recording, report) = read(|bag| {
        add(bag, STATE, &state(1, &["arm"]));
        broken(bag);
    });
    assert_eq!((recording.len(), report.undecodable), (1, 1));
    assert!(report.first_undecodable.unwrap().contains("message 1 on topic /arm/state (7 bytes)"));
    let error = error(broken);
    assert!(matches!(error, BagError::Undecodable { index: 0, bytes: 7, .. }), "{error}");
}

#[test]
fn a_topic_cannot_change_its_type_while_writing() {
    let (_folder, _path) = bag(|bag| {
        add(bag, STATE, &state(1, &[]));
        let error = bag.add_topic(&topic_to_write::<OrificeCommand>(STATE, Qos::reliable(1))).unwrap_err();
        assert!(matches!(error, rosbag2::Error::TopicConflict { .. }), "{error}");
    });
}

#[test]
fn paths_that_are_no_bags_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let read = |path: &Path| read_recording(path, &Topics::default()).unwrap_err();
    assert!(matches!(read(&folder.path().join("nothing")), BagError::Bag(rosbag2::Error::DoesNotExist { .. })));
    assert!(matches!(read(folder.path()), BagError::Bag(rosbag2::Error::NotABag { .. })));
    let text = folder.path().join("text.mcap");
    std::fs::write(&text, "not a bag").unwrap();
    assert!(matches!(read(&text), BagError::Bag(rosbag2::Error::NotABag { .. })));
    let database = folder.path().join("database.db3");
    std::fs::write(&database, "SQLite format 3\0").unwrap();
    let error = read(&database);
    assert!(matches!(error, BagError::Bag(rosbag2::Error::NotABag { .. })), "{error}");
    assert!(error.to_string().contains("is a SQLite3 file that cannot be read"), "{error}");
    let metadata = folder.path().join("metadata.yaml");
    std::fs::write(&metadata, "rosbag2_bagfile_information: [").unwrap();
    assert!(matches!(read(folder.path()), BagError::Bag(rosbag2::Error::BadMetadata { .. })));
    let text = "rosbag2_bagfile_information:\n  storage_identifier: mcap\n  relative_file_paths: [gone.mcap]\n";
    std::fs::write(&metadata, text).unwrap();
    assert!(
        matches!(read(folder.path()), BagError::Bag(rosbag2::Error::MissingFile { file, .. }) if file == "gone.mcap")
    );
}
