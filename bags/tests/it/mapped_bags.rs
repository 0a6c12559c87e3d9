//! Topic maps on bags: units, signs, offsets, clocks, stamps, resampling, and clear words about what does not fit.

use crate::support;
use std::path::PathBuf;

use excavator_bags::map::{MapError, Origin, TopicMap, read_mapped, read_recording_or_mapped};
use excavator_bags::{BagError, ReadReport};
use excavator_model::recording::Recording;
use excavator_msgs::Header;
use rosbag2::{BagWriter, TopicToWrite, WriteOptions, cdr};
use serde::Serialize;

#[derive(Serialize)]
struct Float64 {
    data: f64,
}

#[derive(Serialize)]
struct Pressure {
    header: Header,
    fluid_pressure: f64,
    variance: f64,
}

const MS: i64 = 1_000_000;
const START: i64 = 1_000_000_000_000;

/// A bag with a position in mm on `/position` (100 Hz, no header) and a pressure in bar on `/pressure` (50 Hz, with a
/// header, logged 3 ms late, silent from 0.4 s to 0.7 s), one second long.
struct Bag {
    folder: tempfile::TempDir,
}

impl Bag {
    fn new() -> Bag {
        let folder = tempfile::tempdir().unwrap();
        let mut bag = BagWriter::create(&folder.path().join("bag"), &WriteOptions::default()).unwrap();
        let mut topic = |name: &str, type_name: &str, schema: &str| {
            let topic = TopicToWrite {
                name: name.to_string(),
                type_name: type_name.to_string(),
                schema: schema.to_string(),
                qos: Vec::new(),
            };
            bag.add_topic(&topic).unwrap()
        };
        let position = topic("/position", "std_msgs/msg/Float64", "float64 data");
        let fluid = "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance";
        let pressure = topic("/pressure", "sensor_msgs/msg/FluidPressure", fluid);
        topic("/silent", "std_msgs/msg/Float64", "float64 data");
        for i in 0..=100_i64 {
            let now = START + 10 * i * MS;
            let write = |bag: &mut BagWriter, id, time: i64, bytes: Vec<u8>| {
                bag.write(id, time as u64, time as u64, &bytes).unwrap();
            };
            write(&mut bag, position, now, cdr::encode(&Float64 { data: i as f64 }).unwrap());
            if i % 2 == 0 && !(41..70).contains(&i) {
                let message = Pressure { header: support::header(now), fluid_pressure: 2.0 * i as f64, variance: 0.0 };
                write(&mut bag, pressure, now + 3 * MS, cdr::encode(&message).unwrap());
            }
        }
        bag.finish().unwrap();
        Bag { folder }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("bag")
    }

    fn read(&self, map: &str) -> Result<(Recording, ReadReport), BagError> {
        read_mapped(&self.path(), &map.parse::<TopicMap>()?)
    }

    fn error(&self, map: &str) -> String {
        self.read(map).unwrap_err().to_string()
    }
}

fn source(signal: &str, topic: &str, field: &str, more: &str) -> String {
    format!("[[signals]]\nsignal = \"{signal}\"\ntopic = \"{topic}\"\nfield = \"{field}\"\n{more}\n")
}

#[test]
fn numbers_become_si_values() {
    let bag = Bag::new();
    let with = |more: &str| {
        let (recording, _) = bag.read(&source("arm.displacement", "/position", "data", more)).unwrap();
        recording.cylinders[0].displacement[50]
    };
    assert_eq!(with(""), 50.0);
    assert_eq!(with("unit = \"mm\""), 50.0 / 1e3);
    assert_eq!(with("unit = \"mm\"\nsign = -1\noffset = \"20 mm\""), -50.0 / 1e3 + 0.02);
    assert_eq!(with("unit = \"mm\"\nscale = 2.0\noffset = 0.5"), 2.0 * (50.0 / 1e3) + 0.5);
    assert_eq!(with("unit = \"in\""), 50.0 * 0.0254);
    // 4 mA to 20 mA over 160 mm.
    let current = with("unit = \"mA\"\nscale = \"10 mm/mA\"\noffset = \"-40 mm\"");
    assert!((current - 0.46).abs() < 1e-12, "{current}");
    let (recording, _) = bag.read(&source("pump_flow", "/position", "data", "unit = \"l/min\"")).unwrap();
    assert!((recording.pump_flow[60] - 1e-3).abs() < 1e-18);
    let (recording, _) = bag.read(&source("oil_temperature", "/position", "data", "unit = \"K\"")).unwrap();
    assert!((recording.oil_temperature[60] - (60.0 - 273.15)).abs() < 1e-12);
    let (recording, _) = bag.read(&source("arm.joint_angle", "/position", "data", "unit = \"°\"")).unwrap();
    assert!((recording.cylinders[0].joint_angle[90] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    let constant = "[[signals]]\nsignal = \"tank_pressure\"\nvalue = \"2 bar\"\n";
    let map = source("arm.displacement", "/position", "data", "") + constant;
    assert!(bag.read(&map).unwrap().0.tank_pressure.iter().all(|&pressure| pressure == 2e5));
}

#[test]
fn stamps_are_those_of_the_header_where_there_is_one() {
    let bag = Bag::new();
    let map = |more: &str| {
        source("arm.displacement", "/position", "data", "unit = \"mm\"")
            + &source("pump_pressure", "/pressure", "fluid_pressure", &format!("unit = \"bar\"\n{more}"))
    };
    // The pressure is 2 bar per 10 ms of its time stamp.
    let pressure_at_200_ms = |more: &str| bag.read(&map(more)).unwrap().0.pump_pressure[20] / 1e5;
    assert!((pressure_at_200_ms("") - 40.0).abs() < 1e-9);
    assert!((pressure_at_200_ms("stamp = \"header\"") - 40.0).abs() < 1e-9);
    assert!((pressure_at_200_ms("stamp = \"header.stamp\"") - 40.0).abs() < 1e-9);
    assert!((pressure_at_200_ms("stamp = \"log\"") - 39.4).abs() < 1e-9);
    assert!((pressure_at_200_ms("stamp = \"log\"\ntime_shift = -0.003") - 40.0).abs() < 1e-9);
    assert!((pressure_at_200_ms("stamp = \"log\"\nresample = \"hold\"") - 36.0).abs() < 1e-9);
    let text = bag.error(&source("arm.displacement", "/position", "data", "stamp = \"header\""));
    assert!(text.contains("std_msgs/Float64 has no field \"header\""), "{text}");
}

#[test]
fn silence_stays_unmeasured_and_is_told() {
    let bag = Bag::new();
    let map = source("arm.displacement", "/position", "data", "")
        + &source("pump_pressure", "/pressure", "fluid_pressure", "unit = \"bar\"");
    let (recording, report) = bag.read(&map).unwrap();
    let missing: Vec<usize> = (0..101).filter(|&i| recording.pump_pressure[i].is_nan()).collect();
    assert_eq!(missing, (41..70).collect::<Vec<_>>());
    assert!(report.notes.iter().any(|note| note.starts_with("pump_pressure has no value at 29 of 101")), "{report:?}");
    let bridged = source("arm.displacement", "/position", "data", "")
        + &source("pump_pressure", "/pressure", "fluid_pressure", "unit = \"bar\"\nmaximum_gap = 0.35");
    assert!(bag.read(&bridged).unwrap().0.pump_pressure.iter().all(|pressure| pressure.is_finite()));
}

#[test]
fn the_clock_is_the_fastest_topic_or_the_one_asked_for() {
    let bag = Bag::new();
    let signals = source("pump_pressure", "/pressure", "fluid_pressure", "unit = \"bar\"")
        + &source("arm.displacement", "/position", "data", "");
    assert_eq!(bag.read(&signals).unwrap().0.len(), 101);
    let (slow, _) = bag.read(&format!("[clock]\ntopic = \"/pressure\"\n{signals}")).unwrap();
    assert_eq!((slow.len(), slow.start_nanoseconds), (37, START));
    let (logged, _) = bag.read(&format!("[clock]\ntopic = \"/pressure\"\nstamp = \"log\"\n{signals}")).unwrap();
    assert_eq!(logged.start_nanoseconds, START + 3 * MS);
    // The clock may be a topic without any signal.
    let other = format!("[clock]\ntopic = \"/pressure\"\n{}", source("arm.displacement", "/position", "data", ""));
    assert_eq!(bag.read(&other).unwrap().0.len(), 37);
}

#[test]
fn a_map_beside_the_bag_is_found() {
    let bag = Bag::new();
    assert!(matches!(read_recording_or_mapped(&bag.path(), Origin::default()), Err(BagError::NoTopic { .. })));
    std::fs::write(bag.path().join("map.toml"), source("arm.displacement", "/position", "data", "")).unwrap();
    assert_eq!(read_recording_or_mapped(&bag.path(), Origin::default()).unwrap().0.len(), 101);
}

#[test]
fn what_does_not_fit_is_told_in_one_line() {
    let bag = Bag::new();
    let position = |more: &str| bag.error(&source("arm.displacement", "/position", "data", more));
    for (text, parts) in [
        (position("unit = \"bar\""), &["arm.displacement is a length", "bar is a pressure", "scale"][..]),
        (position("unit = \"furlong\""), &["\"furlong\" is no unit", "mm"]),
        (position("unit = \"V\"\nscale = \"25 bar/V\""), &["25 bar/V", "scale"]),
        (position("offset = \"3 bar\""), &["3 bar", "offset"]),
        (position("sign = 3"), &["sign", "1 or -1"]),
        (position("maximum_gap = -1.0"), &["maximum_gap", "positive"]),
        (position("colour = \"red\""), &["line", "colour"]),
        (bag.error(&source("arm.length", "/position", "data", "")), &["arm.length", "displacement"]),
        (bag.error(&source("displacement", "/position", "data", "")), &["no signal \"displacement\""]),
        (bag.error(&source("arm.pump_pressure", "/position", "data", "")), &["arm.pump_pressure"]),
        (bag.error(&source("arm.displacement", "/position", "value", "")), &["no field \"value\"", "data"]),
        (bag.error(&source("arm.displacement", "/nowhere", "data", "")), &["no topic /nowhere", "/position"]),
        (bag.error(&source("arm.displacement", "/silent", "data", "")), &["/silent has no readable message"]),
        (bag.error("[[signals]]\nsignal = \"pump_flow\"\n"), &["pump_flow", "topic", "column"]),
        (
            bag.error("[[signals]]\nsignal = \"pump_flow\"\ncolumn = \"a\"\n"),
            &["pump_flow is taken from a column", "bag"],
        ),
        (bag.error(""), &["no [[signals]]"]),
    ] {
        assert_eq!(text.lines().count(), 1, "{text}");
        for part in parts {
            assert!(text.contains(part), "\"{part}\" is missing in: {text}");
        }
    }
    let twice = source("arm.displacement", "/position", "data", "").repeat(2);
    assert!(matches!(twice.parse::<TopicMap>(), Err(MapError::SignalTwice { .. })));
}

#[test]
fn types_that_nobody_defines_come_from_msg_files() {
    let bag = Bag::new();
    let folder = bag.folder.path();
    let other = folder.join("other");
    let mut writer = BagWriter::create(&other, &WriteOptions::default()).unwrap();
    let topic = TopicToWrite {
        name: "/valve".to_string(),
        type_name: "valve_msgs/msg/Spool".to_string(),
        schema: String::new(),
        qos: Vec::new(),
    };
    let id = writer.add_topic(&topic).unwrap();
    writer.write(id, 5, 5, &cdr::encode(&Float64 { data: 1e-5 }).unwrap()).unwrap();
    writer.finish().unwrap();
    let signals = source("arm.orifice_area", "/valve", "area", "");
    let error = read_mapped(&other, &signals.parse().unwrap()).unwrap_err().to_string();
    assert!(error.contains("valve_msgs/Spool is not defined") && error.contains("definitions"), "{error}");
    std::fs::create_dir_all(folder.join("valve_msgs/msg")).unwrap();
    std::fs::write(folder.join("valve_msgs/msg/Spool.msg"), "float64 area # m2\n").unwrap();
    let map = folder.join("spool.toml");
    std::fs::write(&map, format!("definitions = [\"valve_msgs/msg/Spool.msg\"]\n{signals}")).unwrap();
    let (recording, _) = read_recording_or_mapped(&other, Origin { map: Some(&map), ..Origin::default() }).unwrap();
    assert_eq!(recording.cylinders[0].orifice_area, [1e-5]);
}
