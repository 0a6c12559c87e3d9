//! What several tests need: made-up recordings, comparison with NaN, the folder with other people's files.

#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::{Path, PathBuf};

use excavator_bags::{Topics, topic_to_write, write_recording};
use excavator_model::recording::Recording;
use excavator_msgs::{ArmState, CylinderState, Header, Message, OrificeCommand, Time};
use rosbag2::{BagWriter, Compression, Qos, RawMessages, WriteOptions, cdr};
use serde::Serialize;

/// Start of all made-up recordings, ns since the epoch.
pub const START: i64 = 1_790_000_000_000_024_320;

/// `can_msgs/msg/Frame`.
#[derive(Serialize)]
pub struct Frame {
    pub header: Header,
    pub id: u32,
    pub is_rtr: bool,
    pub is_extended: bool,
    pub is_error: bool,
    pub dlc: u8,
    pub data: [u8; 8],
}

/// Two cylinders, 500 Hz, with everything that makes reading hard: uneven stamps, NaN, a sensor that is not there,
/// commands that begin late, change one at a time and end.
pub fn recording(samples: usize) -> Recording {
    let time: Vec<f64> =
        (0..samples as i64).map(|i| (i * 2_000_000 + (i * 7919 % 40_000) * i64::from(i > 0)) as f64 / 1e9).collect();
    let mut recording = Recording::unmeasured("made up", time, &["boom", "arm"]);
    recording.start_nanoseconds = START;
    for i in 0..samples {
        let t = recording.time[i];
        recording.pump_pressure[i] = 2e7 + 1e5 * (3.0 * t).sin();
        recording.tank_pressure[i] = if i % 17 == 0 { f64::NAN } else { 2e5 + i as f64 / 3.0 };
        recording.oil_temperature[i] = 40.0 + 0.1 * t;
        for (k, cylinder) in recording.cylinders.iter_mut().enumerate() {
            let phase = t + k as f64;
            cylinder.displacement[i] = 0.1 * phase.sin();
            cylinder.joint_angle[i] = phase.cos();
            cylinder.cap_pressure[i] = 5e6 * (2.0 * phase).sin();
            cylinder.rod_pressure[i] = f64::MIN_POSITIVE * i as f64;
            cylinder.orifice_area[i] = -1e-4 * phase.cos();
            cylinder.orifice_command[i] = match i / (10 * (k + 1)) {
                0 => f64::NAN,
                step if step % 7 == 3 => f64::NAN,
                step => 1e-5 * (step % 5) as f64,
            };
        }
    }
    recording
}

/// Panics unless the recordings are equal bit for bit, `NaN` equal to `NaN`; the source is not compared.
pub fn assert_equal(found: &Recording, expected: &Recording) {
    let bits = |values: &[f64]| -> Vec<u64> {
        values.iter().map(|value| if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }).collect()
    };
    assert_eq!(found.start_nanoseconds, expected.start_nanoseconds);
    assert_eq!(bits(&found.time), bits(&expected.time), "time");
    let (found, expected) = (found.signals(), expected.signals());
    assert_eq!(found.len(), expected.len(), "number of signals");
    for ((name, values), (expected_name, expected_values)) in found.into_iter().zip(expected) {
        assert_eq!(name, expected_name);
        assert_eq!(bits(values), bits(expected_values), "{name}");
    }
}

/// Writes a recording with small chunks and gives the path of its MCAP file.
pub fn write_small_chunks(folder: &Path, recording: &Recording, compression: Compression) -> PathBuf {
    let options = WriteOptions { compression, chunk_size: 16 * 1024, ..WriteOptions::default() };
    write_recording(folder, recording, &Topics::default(), &options).unwrap();
    mcap_file(folder)
}

/// The MCAP file of a folder that we wrote.
pub fn mcap_file(folder: &Path) -> PathBuf {
    folder.join(format!("{}_0.mcap", folder.file_name().unwrap().to_string_lossy()))
}

/// A state message of the given cylinders with recognisable numbers.
pub fn state(nanoseconds: i64, cylinders: &[&str]) -> ArmState {
    ArmState {
        header: header(nanoseconds),
        cylinders: cylinders
            .iter()
            .map(|name| CylinderState { displacement: nanoseconds as f64, ..CylinderState::unmeasured(name) })
            .collect(),
        pump_pressure: 1.0,
        tank_pressure: 2.0,
        pump_flow: 3.0,
        oil_temperature: 4.0,
    }
}

/// A command.
pub fn command(nanoseconds: i64, names: &[&str], areas: &[f64]) -> OrificeCommand {
    OrificeCommand {
        header: header(nanoseconds),
        names: names.iter().map(ToString::to_string).collect(),
        areas: areas.to_vec(),
    }
}

/// A header with this stamp, ns.
pub fn header(nanoseconds: i64) -> Header {
    Header { stamp: Time::from_nanoseconds(nanoseconds).unwrap(), frame_id: String::new() }
}

/// Writes one message at log time 0: what counts are the stamps.
pub fn add<M: Message>(bag: &mut BagWriter, topic: &str, message: &M) {
    let id = bag.add_topic(&topic_to_write::<M>(topic, Qos::reliable(10))).unwrap();
    bag.write(id, 0, 0, &cdr::encode(message).unwrap()).unwrap();
}

/// The folder of other people's files, or `None` with a line that says what is skipped.
pub fn shared(what: &str) -> Option<PathBuf> {
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

/// Writes the messages of a bag as a SQLite3 file of rosbag2, as version 4 of its tables has them.
pub fn to_sqlite(bag: &Path, database: &Path) {
    let mut connection = rusqlite::Connection::open(database).unwrap();
    connection
        .execute_batch(
            "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
             CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
                 serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
                 type_description_hash TEXT NOT NULL);
             CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
                 encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);
             CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
                 data BLOB NOT NULL);
             CREATE INDEX timestamp_idx ON messages (timestamp ASC);
             INSERT INTO schema VALUES (4, 'jazzy');",
        )
        .unwrap();
    let transaction = connection.transaction().unwrap();
    let mut topics: Vec<String> = Vec::new();
    for message in RawMessages::open(bag).unwrap() {
        let message = message.unwrap();
        let topic = &message.topic;
        let id = match topics.iter().position(|name| *name == topic.name) {
            Some(index) => index + 1,
            None => {
                topics.push(topic.name.clone());
                transaction
                    .execute(
                        "INSERT INTO topics VALUES (?1, ?2, ?3, ?4, ?5, '')",
                        rusqlite::params![
                            topics.len() as i64,
                            topic.name,
                            topic.type_name,
                            topic.message_encoding,
                            topic.offered_qos_profiles
                        ],
                    )
                    .unwrap();
                transaction
                    .execute(
                        "INSERT INTO message_definitions VALUES (?1, ?2, ?3, ?4, '')",
                        rusqlite::params![topics.len() as i64, topic.type_name, topic.schema_encoding, topic.schema],
                    )
                    .unwrap();
                topics.len()
            }
        };
        transaction
            .execute(
                "INSERT INTO messages(topic_id, timestamp, data) VALUES (?1, ?2, ?3)",
                rusqlite::params![id as i64, message.log_time as i64, message.data.as_ref()],
            )
            .unwrap();
    }
    transaction.commit().unwrap();
}

/// A generator of numbers that needs no crate: xorshift, Marsaglia 2003.
pub struct Numbers(pub u64);

impl Numbers {
    /// A number from 0 to `limit` - 1.
    pub fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit as u64) as usize
    }
}
