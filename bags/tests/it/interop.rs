//! Bags between us and Python's rosbags and mcap-ros2-support, both ways, compared bit for bit.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{mcap_file, recording};
use excavator_bags::{Topics, read_recording, write_recording};
use excavator_model::recording::Recording;
use rosbag2::WriteOptions;
use serde_json::Value;

/// An interpreter that has the two libraries, or `None` with a line that says what is skipped.
fn python() -> Option<PathBuf> {
    let python = match std::env::var_os("EXCAVATOR_PYTHON") {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../.venv/bin/python"),
    };
    let has_libraries = Command::new(&python)
        .args(["-c", "import rosbags, mcap_ros2"])
        .output()
        .is_ok_and(|output| output.status.success());
    if !has_libraries {
        eprintln!(
            "skipped: {} has no rosbags and mcap-ros2-support (set EXCAVATOR_PYTHON to an interpreter that has)",
            python.display()
        );
    }
    has_libraries.then_some(python)
}

fn run(python: &Path, script: &str, arguments: &[&Path]) -> Vec<u8> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/interop").join(script);
    let output = Command::new(python).arg(&script).args(arguments).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{} failed:\n{errors}", script.display());
    output.stdout
}

fn bits(value: f64) -> String {
    format!("{:016x}", value.to_bits())
}

fn strings(value: &Value) -> Vec<String> {
    value.as_array().unwrap().iter().map(|item| item.as_str().unwrap().to_string()).collect()
}

/// Panics unless the messages that a Python reader saw are those of the recording.
fn assert_seen(topics: &Value, recording: &Recording, reader: &str) {
    let states = &topics["/arm/state"];
    assert_eq!(states["type"], "excavator_msgs/msg/ArmState", "{reader}");
    let states = states["messages"].as_array().unwrap();
    assert_eq!(states.len(), recording.len(), "{reader}");
    for (i, state) in states.iter().enumerate() {
        let stamp = recording.start_nanoseconds + (recording.time[i] * 1e9).round() as i64;
        assert_eq!(state["stamp"].as_i64(), Some(stamp), "{reader}");
        let shared =
            [&recording.pump_pressure, &recording.tank_pressure, &recording.pump_flow, &recording.oil_temperature];
        assert_eq!(strings(&state["shared"]), shared.map(|signal| bits(signal[i])), "{reader}");
        for (cylinder, seen) in recording.cylinders.iter().zip(state["cylinders"].as_array().unwrap()) {
            assert_eq!(seen["name"], cylinder.name, "{reader}");
            let measured = &cylinder.signals()[..7];
            let expected: Vec<String> = measured.iter().map(|(_, values)| bits(values[i])).collect();
            assert_eq!(strings(&seen["values"]), expected, "{reader}");
        }
    }
    let mut held: Vec<(String, Value)> = Vec::new();
    for command in topics["/arm/orifice_command"]["messages"].as_array().unwrap() {
        for (name, area) in strings(&command["names"]).into_iter().zip(command["areas"].as_array().unwrap()) {
            held.retain(|(known, _)| *known != name);
            held.push((name, area.clone()));
        }
    }
    assert_eq!(held.len(), recording.cylinders.len());
    for (name, area) in held {
        let last = recording.cylinder(&name).unwrap().orifice_command[recording.len() - 1];
        assert_eq!(area, bits(last), "{reader}");
    }
}

#[test]
fn python_reads_what_we_write() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let original = recording(400);
    write_recording(&bag, &original, &Topics::default(), &WriteOptions::default()).unwrap();
    let output = run(&python, "read_bag.py", &[&bag, &mcap_file(&bag)]);
    let seen: Value = serde_json::from_slice(&output).unwrap();
    for reader in ["rosbags", "mcap"] {
        assert_seen(&seen[reader], &original, reader);
    }
}

#[test]
fn python_reads_a_bag_that_we_split() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let original = recording(400);
    let tenth = (original.duration() * 1e8) as u64;
    let options = WriteOptions { most_file_nanoseconds: Some(tenth), ..WriteOptions::default() };
    write_recording(&bag, &original, &Topics::default(), &options).unwrap();
    let files = std::fs::read_dir(&bag).unwrap().count() - 1;
    assert!(files >= 10, "{files} files");
    let output = run(&python, "read_bag.py", &[&bag, &bag.join("bag_0.mcap")]);
    let seen: Value = serde_json::from_slice(&output).unwrap();
    assert_seen(&seen["rosbags"], &original, "rosbags");
}

#[test]
fn we_read_what_python_writes() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let definitions = Path::new(env!("CARGO_MANIFEST_DIR")).join("../msgs/msg");
    run(&python, "write_bag.py", &[&bag, &definitions]);
    let (found, report) = read_recording(&bag, &Topics::default()).unwrap();
    assert_eq!(report.problems(), Vec::<String>::new());
    assert_eq!((found.len(), found.start_nanoseconds), (200, 1_000_000_000));
    let arm = found.cylinder("arm").unwrap();
    for i in 0..200 {
        assert_eq!(found.time[i], (2 * i) as f64 / 1e3);
        assert_eq!(arm.displacement[i], 0.001 * i as f64);
        assert_eq!(arm.orifice_command[i], 1e-6 * (i / 10 * 10) as f64);
        assert!(arm.velocity[i].is_nan() && found.tank_pressure[i].is_nan());
        assert_eq!(found.oil_temperature[i], 45.5);
    }
}
