//! One drive as a few hundred bags of strangers: every storage and compression, with clocks, stamps, publishers and losses
//! of each kind. Each bag is read as the truth, and what is wrong with it is told.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use excavator_bags::ReadReport;
use excavator_bags::map::{TopicMap, read_mapped};
use excavator_model::recording::Recording;
use excavator_msgs::Header;
use rosbag2::{BagWriter, Compression, RawMessages, TopicToWrite, WriteOptions, cdr};
use serde::Serialize;

use crate::support::{header, to_sqlite};

const SAMPLES: i64 = 240;
/// Interval of the samples, ns.
const STEP: i64 = 5_000_000;
/// Log time of the first sample, and its stamp in a simulation, ns.
const START: i64 = 1_790_000_000_000_000_000;
const SIMULATED: i64 = 7_000_000_000;
/// Time on the way to the recorder, ns.
const DELAY: i64 = 300_000;
/// Samples that are lost from the topic of the position.
const LOST: std::ops::Range<i64> = 100..108;

#[derive(Serialize)]
struct Stamped {
    header: Header,
    data: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Clock {
    Same,
    /// The stamps are this much later than the log, ns; earlier if negative.
    Offset(i64),
    Simulation,
    Drift,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Stamps {
    Set,
    Zero,
    Equal,
    Reversed,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    None,
    SecondPublisher,
    Losses,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Drive {
    clock: Clock,
    stamps: Stamps,
    fault: Fault,
    /// Whether the pressure has a header too.
    all_stamped: bool,
    /// Whether the pressure is then stamped by another clock, that of the log.
    two_devices: bool,
}

fn position(time: f64) -> f64 {
    0.3 + 0.1 * (TAU * time / 0.9).sin()
}

fn pressure(time: f64) -> f64 {
    5e6 + 2e6 * (TAU * time / 0.7).cos()
}

impl Drive {
    fn stamp(&self, sample: i64) -> i64 {
        let now = match self.stamps {
            Stamps::Set => STEP * sample,
            Stamps::Zero => return 0,
            Stamps::Equal => 0,
            Stamps::Reversed => STEP * (SAMPLES - sample),
        };
        match self.clock {
            Clock::Same => START + now,
            Clock::Offset(offset) => START + now + offset,
            Clock::Simulation => SIMULATED + now,
            Clock::Drift => START + now + now / 25,
        }
    }

    /// Whether stamps in headers are no clock for all topics.
    fn is_read_by_log(&self) -> bool {
        match self.stamps {
            Stamps::Zero => false,
            Stamps::Equal | Stamps::Reversed => true,
            Stamps::Set => (!self.all_stamped || self.two_devices) && self.clock != Clock::Same,
        }
    }

    fn write(&self, bag: &Path, compression: Compression) {
        let options = WriteOptions { compression, ..WriteOptions::default() };
        let mut writer = BagWriter::create(bag, &options).unwrap();
        let mut add = |name: &str, type_name: &str, schema: &str| {
            let (name, type_name, schema) = (name.into(), type_name.into(), schema.into());
            writer.add_topic(&TopicToWrite { name, type_name, schema, qos: Vec::new() }).unwrap()
        };
        let stamped = "std_msgs/Header header\nfloat64 data";
        let positions = add("/position", "test_msgs/msg/Stamped", stamped);
        let pressures = match self.all_stamped {
            true => add("/pressure", "test_msgs/msg/Stamped", stamped),
            false => add("/pressure", "std_msgs/msg/Float64", "float64 data"),
        };
        let losses = "string node_name\nrosbag2_interfaces/MessagesLostEventTopicStat[] messages_lost_statistics\n";
        let events = add("/events/rosbag2_messages_lost", "rosbag2_interfaces/msg/MessagesLostEvent", losses);
        let mut write =
            |topic, time: i64, bytes: Vec<u8>| writer.write(topic, time as u64, time as u64, &bytes).unwrap();
        for sample in 0..SAMPLES {
            let (time, log) = ((STEP * sample) as f64 / 1e9, START + STEP * sample + DELAY);
            let message = |data: f64| cdr::encode(&Stamped { header: header(self.stamp(sample)), data }).unwrap();
            if self.fault != Fault::Losses || !LOST.contains(&sample) {
                write(positions, log, message(position(time)));
            }
            if self.fault == Fault::SecondPublisher && sample % 12 == 5 {
                write(positions, log + 400_000, message(0.0));
            }
            let of_pressure = if self.two_devices { Drive { clock: Clock::Same, ..*self } } else { *self };
            let bytes = match self.all_stamped {
                true => cdr::encode(&Stamped { header: header(of_pressure.stamp(sample)), data: pressure(time) }),
                false => cdr::encode(&pressure(time)),
            };
            let bytes = bytes.unwrap();
            write(pressures, log, bytes);
        }
        if self.fault == Fault::Losses {
            let lost = ("/recorder", vec![("/position", LOST.count() as u64, 0_u64)]);
            write(events, START + STEP * SAMPLES, cdr::encode(&lost).unwrap());
        }
        writer.finish().unwrap();
    }
}

fn check(drive: Drive, kind: &str, bag: &Path) {
    let map: TopicMap = "[[signals]]\nsignal = \"arm.displacement\"\ntopic = \"/position\"\nfield = \"data\"\n\
                         [[signals]]\nsignal = \"arm.cap_pressure\"\ntopic = \"/pressure\"\nfield = \"data\"\n"
        .parse()
        .unwrap();
    let (recording, report) = read_mapped(bag, &map).unwrap_or_else(|error| panic!("{kind}, {drive:?}: {error}"));
    check_values(drive, kind, &recording);
    check_report(drive, kind, &report);
}

/// Every value is that of its time, on whichever clock was read.
fn check_values(drive: Drive, kind: &str, recording: &Recording) {
    let first = recording.start_nanoseconds;
    let begin = if (first - START).abs() < STEP { START } else { drive.stamp(0) };
    let is_stamped = drive.all_stamped && !drive.is_read_by_log();
    let arm = &recording.cylinders[0];
    let mut values = 0;
    for (sample, time) in recording.time.iter().enumerate() {
        let mut time = (first - begin) as f64 / 1e9 + time;
        if drive.clock == Clock::Drift && is_stamped {
            time /= 1.04;
        }
        let (displacement, pressure_error) =
            (arm.displacement[sample], (arm.cap_pressure[sample] - pressure(time)).abs() / 2e6);
        // 0.3 ms on the way, and lines between samples.
        assert!(pressure_error.is_nan() || pressure_error < 0.01, "{kind}, {drive:?}: pressure at {time}");
        if displacement.is_finite() {
            let error = (displacement - position(time)).abs() / 0.1;
            assert!(error < 0.02, "{kind}, {drive:?}: {displacement} at {time}, not {}", position(time));
            values += 1;
        }
    }
    assert!(values >= SAMPLES * 9 / 10, "{kind}, {drive:?}: {values} values");
}

fn check_report(drive: Drive, kind: &str, report: &ReadReport) {
    let lines = report.problems().join("\n");
    let tells = |words: &str| lines.contains(words);
    assert_eq!(tells("clock: log times for all mapped topics"), drive.is_read_by_log(), "{kind}, {drive:?}: {lines}");
    let is_told = tells("values differ from an earlier one") || tells("single values jump away");
    assert_eq!(is_told, drive.fault == Fault::SecondPublisher, "{kind}, {drive:?}: {lines}");
    let lost: u64 = report.lost.iter().map(|lost| lost.count()).sum();
    assert_eq!(lost, if drive.fault == Fault::Losses { LOST.count() as u64 } else { 0 }, "{kind}, {drive:?}");
    assert_eq!(tells("messages of /position were lost"), lost > 0, "{kind}, {drive:?}: {lines}");
    let of_sources = report.lost_of_sources().join("\n");
    assert_eq!(of_sources.contains("so arm.displacement has gaps"), lost > 0, "{kind}, {drive:?}: {of_sources}");
    assert!(report.damage.is_empty(), "{kind}, {drive:?}: {lines}");
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    zstd::encode_all(bytes, 1).unwrap()
}

fn only_file(bag: &Path) -> PathBuf {
    let files = std::fs::read_dir(bag).unwrap().map(|entry| entry.unwrap().path());
    files.into_iter().find(|path| path.extension().is_some_and(|end| end == "mcap")).unwrap()
}

/// Compresses a file as a whole.
fn pack_file(file: &Path) {
    std::fs::write(format!("{}.zstd", file.display()), packed(&std::fs::read(file).unwrap())).unwrap();
    std::fs::remove_file(file).unwrap();
}

/// The same messages, each compressed by itself.
fn pack_messages(bag: &Path, target: &Path) {
    let mut writer = BagWriter::create(target, &WriteOptions::default()).unwrap();
    for message in RawMessages::open(bag).unwrap() {
        let message = message.unwrap();
        let topic = &message.topic;
        let (name, type_name, schema) = (topic.name.clone(), topic.type_name.clone(), topic.schema.clone());
        let id = writer.add_topic(&TopicToWrite { name, type_name, schema, qos: Vec::new() }).unwrap();
        writer.write(id, message.log_time, message.publish_time, &packed(&message.data)).unwrap();
    }
    writer.finish().unwrap();
}

fn drives() -> Vec<Drive> {
    let mut drives = Vec::new();
    let clocks = [Clock::Same, Clock::Offset(60_000_000), Clock::Offset(-60_000_000), Clock::Simulation, Clock::Drift];
    for clock in clocks {
        for stamps in [Stamps::Set, Stamps::Zero, Stamps::Equal, Stamps::Reversed] {
            for fault in [Fault::None, Fault::SecondPublisher, Fault::Losses] {
                drives.push(Drive { clock, stamps, fault, all_stamped: false, two_devices: false });
            }
        }
        let stamped = Drive { clock, stamps: Stamps::Set, fault: Fault::None, all_stamped: true, two_devices: false };
        drives.push(stamped);
        drives.push(Drive { stamps: Stamps::Equal, ..stamped });
        // Stamps that are 60 ms earlier may be right: then the messages were slow.
        if clock != Clock::Offset(-60_000_000) {
            drives.push(Drive { two_devices: true, ..stamped });
        }
    }
    drives
}

#[test]
fn every_bag_is_read_as_the_truth_and_its_faults_are_told() {
    let mut bags = 0;
    for drive in drives() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for (name, compression) in [("none", Compression::None), ("zstd", Compression::Zstd), ("lz4", Compression::Lz4)]
        {
            drive.write(&at(name), compression);
            check(drive, name, &at(name));
        }
        pack_messages(&at("none"), &at("messages"));
        check(drive, "messages", &at("messages"));
        pack_file(&only_file(&at("lz4")));
        check(drive, "file", &at("lz4"));
        bags += 5;
        if cfg!(feature = "sqlite") && drive.fault != Fault::None {
            for (name, source) in [("plain.db3", "none"), ("file.db3", "zstd")] {
                to_sqlite(&at(source), &at(name));
            }
            check(drive, "sqlite", &at("plain.db3"));
            pack_file(&at("file.db3"));
            check(drive, "sqlite file", &at("file.db3.zstd"));
            bags += 2;
        }
    }
    assert!(bags >= 400, "{bags}");
}
