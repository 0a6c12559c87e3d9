//! Guessed maps: the right signals for clear reasons, a map that can be used as it is, and silence where nothing is known.

#![allow(clippy::unwrap_used)]

mod support;

use std::path::Path;

use excavator_bags::map::{Guess, TopicMap, guess, read_mapped};
use support::shared;

fn pairs(guess: &Guess) -> Vec<(String, String, String)> {
    let pairs = guess.signals.iter().map(|guessed| {
        let source = &guessed.source;
        let origin = match (&source.column, &source.topic, &source.field) {
            (Some(column), _, _) => column.to_string(),
            (_, Some(topic), Some(field)) => format!("{topic} {field}"),
            _ => String::new(),
        };
        (source.signal.to_string(), origin, source.unit.clone().unwrap_or_default())
    });
    pairs.collect()
}

fn assert_guessed(guess: &Guess, expected: &[(&str, &str, &str)]) {
    let found = pairs(guess);
    for &(signal, origin, unit) in expected {
        let wanted = (signal.to_string(), origin.to_string(), unit.to_string());
        assert!(found.contains(&wanted), "{signal} is not {origin} in {unit}:\n{}", guess.to_text().unwrap());
    }
}

/// A table of a swinging arm; `columns` are headings with factor from SI.
fn table(columns: [(&str, f64); 7]) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.csv");
    let mut text = columns.map(|(heading, _)| heading.to_string()).join(",") + "\n";
    for i in 0..2000 {
        let t = f64::from(i) * 2e-3;
        let swing = (3.0 * t).sin();
        let si = [t, 0.1 * swing, 0.3 * (3.0 * t).cos(), 2e7 + 1e5 * swing, 6e6 + 3e6 * swing, 3e6 - 1e6 * swing, 2e5];
        let row: Vec<String> =
            si.iter().zip(columns).map(|(value, (_, factor))| (value * factor).to_string()).collect();
        text += &(row.join(",") + "\n");
    }
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

#[test]
fn names_with_units_need_no_shapes() {
    let columns = [
        ("time [ms]", 1e3),
        ("boom stroke [mm]", 1e3),
        ("boom speed [mm/s]", 1e3),
        ("p_pump [bar]", 1e-5),
        ("boom pA [bar]", 1e-5),
        ("boom pB [bar]", 1e-5),
        ("tank pressure [kPa]", 1e-3),
    ];
    let (_folder, path) = table(columns);
    let guessed = guess(&path, "arm").unwrap();
    let expected = [
        ("boom.displacement", "boom stroke", "mm"),
        ("boom.velocity", "boom speed", "mm/s"),
        ("pump_pressure", "p_pump", "bar"),
        ("boom.cap_pressure", "boom pA", "bar"),
        ("boom.rod_pressure", "boom pB", "bar"),
        ("tank_pressure", "tank pressure", "kPa"),
    ];
    assert_guessed(&guessed, &expected);
    assert_eq!(guessed.signals.len(), 6);
    let speed = guessed.signals.iter().find(|s| s.source.signal.to_string() == "boom.velocity").unwrap();
    assert!(speed.reason.contains("derivative of boom stroke"), "{}", speed.reason);
}

#[test]
fn numbers_tell_units_and_places_where_names_do_not() {
    let columns = [
        ("t", 1.0),
        ("x", 1e3),
        ("v", 1e3),
        ("pressure 7", 1e-5),
        ("pressure 8", 1e-5),
        ("pressure 9", 1e-5),
        ("pressure 6", 1e-5),
    ];
    let (_folder, path) = table(columns);
    let guessed = guess(&path, "arm").unwrap();
    let expected = [
        ("arm.displacement", "x", "mm"),
        ("arm.velocity", "v", "mm/s"),
        ("pump_pressure", "pressure 7", "bar"),
        ("arm.cap_pressure", "pressure 8", "bar"),
        ("arm.rod_pressure", "pressure 9", "bar"),
        ("tank_pressure", "pressure 6", "bar"),
    ];
    assert_guessed(&guessed, &expected);
}

#[test]
fn a_guess_is_a_map_with_a_reason_on_its_lines() {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples");
    for sample in ["arm-swing", "arm-swing.csv", "joint-states"] {
        let guessed = guess(&samples.join(sample), "arm").unwrap();
        let text = guessed.to_text().unwrap();
        let map: TopicMap = text.parse().unwrap();
        assert_eq!(map.signals, guessed.map().signals, "{sample}");
        assert_eq!(map.clock, guessed.map().clock, "{sample}");
        for line in text.lines().filter(|line| line.starts_with("signal = ") || line.starts_with("unit = ")) {
            assert!(line.contains("# "), "{line}");
        }
        // It reads the data that it was guessed from.
        let (recording, _) = read_mapped(&samples.join(sample), &map).unwrap();
        assert_eq!(recording.len(), 501, "{sample}");
    }
}

#[test]
fn our_own_bag_is_guessed_as_what_it_is() {
    let bag = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/arm-swing");
    let guessed = guess(&bag, "load").unwrap();
    let expected = [
        ("arm.displacement", "/arm/state cylinders[name=arm].displacement", "m"),
        ("arm.cap_pressure", "/arm/state cylinders[name=arm].cap_pressure", "Pa"),
        ("arm.rod_pressure", "/arm/state cylinders[name=arm].rod_pressure", "Pa"),
        ("arm.orifice_command", "/arm/orifice_command areas[names=arm]", "m2"),
        ("pump_pressure", "/arm/state pump_pressure", "Pa"),
        ("tank_pressure", "/arm/state tank_pressure", "Pa"),
        ("pump_flow", "/arm/state pump_flow", "m3/s"),
    ];
    assert_guessed(&guessed, &expected);
}

#[test]
fn foreign_topics_and_a_spreadsheet_in_german() {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples");
    let expected = [
        ("arm.displacement", "/joint_states position[name=arm_cylinder]", "mm"),
        ("arm.cap_pressure", "/chambers data[0]", "bar"),
        ("arm.rod_pressure", "/chambers data[1]", "bar"),
        // All zeros, which are the same in every unit.
        ("tank_pressure", "/chambers data[2]", "Pa"),
        ("pump_pressure", "/pump fluid_pressure", "Pa"),
        ("arm.orifice_command", "/valve_current data", "mA"),
    ];
    assert_guessed(&guess(&samples.join("joint-states"), "arm").unwrap(), &expected);
    let expected = [
        ("arm.displacement", "Weg", "mm"),
        ("arm.cap_pressure", "p_A", "bar"),
        ("arm.rod_pressure", "p_B", "bar"),
        ("tank_pressure", "Tankdruck", "bar"),
        ("pump_pressure", "Pumpendruck", "bar"),
        ("arm.orifice_command", "Ventil", "mm2"),
    ];
    assert_guessed(&guess(&samples.join("arm-swing.csv"), "arm").unwrap(), &expected);
}

#[test]
fn a_robot_on_wheels_has_no_hydraulics() {
    let Some(bag) = shared("realdata/bags/plotjuggler") else { return };
    let guessed = guess(&bag, "arm").unwrap();
    let hydraulic = pairs(&guessed).into_iter().filter(|(signal, _, _)| !signal.ends_with("displacement")).count();
    assert_eq!(hydraulic, 0, "{}", guessed.to_text().unwrap());
}
