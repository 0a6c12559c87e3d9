//! Guessed maps: the right signals for clear reasons, a map that can be used as it is, and silence where nothing is known.

use std::path::Path;

use crate::support::shared;
use excavator_bags::map::{Confidence, Guess, TopicMap, guess, read_mapped};

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

/// A table of other people with these headings; every column swings about its mean as fast as the others.
fn swings(columns: &[(&str, f64, f64)]) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.csv");
    let mut text = columns.iter().map(|(heading, ..)| *heading).collect::<Vec<_>>().join(",") + "\n";
    for i in 0..500 {
        let t = f64::from(i) * 1e-2;
        let cell = |(heading, mean, swing): &(&str, f64, f64)| match *heading {
            "ts_ms" => (1.78e12 + 1e3 * t).to_string(),
            // The pump's speed drives the piston: it goes with the derivative of the position.
            heading if heading.contains("speed") => (mean + swing * (3.0 * t).cos()).to_string(),
            _ => (mean + swing * (3.0 * t).sin()).to_string(),
        };
        text += &(columns.iter().map(cell).collect::<Vec<_>>().join(",") + "\n");
    }
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

#[test]
fn the_speed_of_a_pump_is_no_velocity_of_a_piston() {
    let pressures = [("p_cap_bar", 100.0, 20.0), ("p_rod_bar", 40.0, 10.0)];
    for (heading, unit) in [("pump_speed_rpm", "rpm"), ("pump speed [1/min]", "1/min")] {
        let columns =
            [&[("ts_ms", 0.0, 0.0), ("cyl_pos_mm", 250.0, 40.0), (heading, 0.0, 500.0)], &pressures[..]].concat();
        let (_folder, path) = swings(&columns);
        let guessed = guess(&path, "load").unwrap();
        let name = heading.trim_end_matches(" [1/min]");
        assert_guessed(&guessed, &[("load.displacement", "cyl_pos_mm", "mm"), ("pump_flow", name, unit)]);
        let flow = guessed.signals.iter().find(|s| s.source.signal.to_string() == "pump_flow").unwrap();
        assert!(flow.unit_reason.contains("placeholder"), "{}", flow.unit_reason);
        // The guess asks for the scale, and is used with the true one: 10 cm3 per turn.
        let text = guessed.to_text().unwrap();
        let asked = text.parse::<TopicMap>().unwrap_err().to_string();
        assert!(asked.contains("pump_flow is a volume flow") && asked.contains("give `scale`"), "{asked}");
        let text = text.replace(&format!("# scale = \"1 m3/s/{unit}\""), &format!("scale = \"0.01 l/min/{unit}\""));
        let (recording, _) = read_mapped(&path, &text.parse().unwrap()).unwrap();
        assert!((recording.pump_flow[0] - 500.0 * 1e-5 / 60.0).abs() < 1e-12, "{}", recording.pump_flow[0]);
    }
    // Without any unit neither.
    let (_folder, path) = swings(&[("t", 0.0, 1.0), ("x", 0.0, 0.2), ("engine speed", 0.0, 150.0)]);
    let guessed = guess(&path, "load").unwrap();
    assert!(guessed.left.contains(&"engine speed".to_string()), "{}", guessed.to_text().unwrap());
}

#[test]
fn a_crane_with_one_named_cylinder_and_a_joystick() {
    let columns = [
        ("ts_ms", 0.0, 0.0),
        ("joystick_pct", 0.0, 60.0),
        ("stick_cyl_ext_mm", 250.0, 40.0),
        ("P_bottom_bar", 100.0, 20.0),
        ("P_rod_bar", 40.0, 10.0),
    ];
    let (_folder, path) = swings(&columns);
    // Everything is of the cylinder that one heading names, by the name that it has here.
    let guessed = guess(&path, "load").unwrap();
    let expected = [
        ("arm.displacement", "stick_cyl_ext_mm", "mm"),
        ("arm.cap_pressure", "P_bottom_bar", "bar"),
        ("arm.rod_pressure", "P_rod_bar", "bar"),
        ("arm.orifice_command", "joystick_pct", "pct"),
    ];
    assert_guessed(&guessed, &expected);
    assert_eq!(guessed.signals.len(), 4);
    let text = guessed.to_text().unwrap();
    assert!(text.contains("put mid-stroke as offset"), "{text}");
}

/// Levers by a pulse width that rests at a number of its own, and measured positions whose names say nothing else.
#[test]
fn what_follows_a_command_is_its_position_and_where_that_rests_is_closed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.csv");
    let mut text = "Time,Boom Cmd,Stick Cmd,Boom Ms,Stick Ms,Counter\n".to_string();
    let (mut boom, mut stick) = (60.0, 20.0);
    for i in 0..1500 {
        let t = f64::from(i) * 0.02;
        let moving = |from: f64| if t % 10.0 > from && t % 10.0 < from + 3.0 { (2.0 * t).sin() } else { 0.0 };
        let (u, v) = (moving(1.0), moving(5.0));
        boom += 0.3 * u;
        stick -= 0.2 * v;
        text += &format!("{t},{},{},{boom},{stick},{i}\n", 7.4745 + 2.0 * u, 6.895 + 1.5 * v);
    }
    std::fs::write(&path, text).unwrap();
    let guessed = guess(&path, "load").unwrap();
    let expected = [
        ("boom.orifice_command", "Boom Cmd", "mm2"),
        ("boom.displacement", "Boom Ms", "mm"),
        ("arm.orifice_command", "Stick Cmd", "mm2"),
        ("arm.displacement", "Stick Ms", "mm"),
    ];
    assert_guessed(&guessed, &expected);
    assert_eq!(guessed.left, ["Counter"]);
    let reason = |signal: &str| {
        &guessed.signals.iter().find(|guessed| guessed.source.signal.to_string() == signal).unwrap().reason
    };
    assert!(reason("arm.displacement").contains("with the sign turned"), "{}", reason("arm.displacement"));
    assert!(!reason("boom.displacement").contains("with the sign turned"));
    let (recording, _) = read_mapped(&path, &guessed.to_text().unwrap().parse().unwrap()).unwrap();
    let command = &recording.cylinder("boom").unwrap().orifice_command;
    assert!(command[0].abs() < 1e-15 && command.iter().any(|area| *area > 1.5e-6), "{}", command[0]);
}

/// Two columns that are equally likely: neither is taken, and both are told.
#[test]
fn what_may_be_another_is_not_sure() {
    let columns =
        [("t", 0.0, 1.0), ("position 3 [mm]", 9.0, 40.0), ("position 4 [mm]", 5.0, 30.0), ("p_B [bar]", 40.0, 9.0)];
    let (_folder, path) = swings(&columns);
    let mut guessed = guess(&path, "arm").unwrap();
    let of = |guess: &Guess, signal: &str| {
        let found = guess.signals.iter().find(|guessed| guessed.source.signal.to_string() == signal).unwrap();
        let others: Vec<String> = found.alternatives.iter().map(|other| other.label.clone()).collect();
        (found.confidence, found.label.clone(), others)
    };
    let first = "position 3".to_string();
    assert_eq!(of(&guessed, "arm.displacement"), (Confidence::Unsure, first, vec!["position 4".to_string()]));
    assert_eq!(of(&guessed, "arm.rod_pressure"), (Confidence::Sure, "p_B".to_string(), vec![]));
    let text = guessed.to_text().unwrap();
    for part in
        ["\n# signal = \"arm.displacement\"", "another is as likely", "#   or column = \"position 4\"", "# sure: "]
    {
        assert!(text.contains(part), "{text}");
    }
    let map: TopicMap = text.parse().unwrap();
    assert_eq!(map.signals.len(), 1, "{text}");
    let number = guessed.signals.iter().position(|found| found.confidence == Confidence::Unsure).unwrap();
    guessed.choose(number, 1);
    assert_eq!(of(&guessed, "arm.displacement"), (Confidence::Chosen, "position 4".to_string(), vec![]));
    assert!(guessed.left.contains(&"position 3".to_string()), "{:?}", guessed.left);
    assert_eq!(guessed.to_text().unwrap().parse::<TopicMap>().unwrap().signals.len(), 2);
}

/// What the input of a valve shows: it goes with the speed of the piston, without being one.
#[test]
fn a_ratio_that_no_units_have_is_evidence_against() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.csv");
    let velocity_of = |factor: f64| {
        let mut text = "t [s],x [mm],v\n".to_string();
        for i in 0..1000 {
            let t = f64::from(i) * 5e-3;
            text += &format!("{t},{},{}\n", 50.0 + 20.0 * (3.0 * t).sin(), factor * 60.0 * (3.0 * t).cos());
        }
        std::fs::write(&path, text).unwrap();
        let guessed = guess(&path, "load").unwrap();
        guessed
            .signals
            .iter()
            .any(|found| found.source.signal.to_string() == "load.velocity" && found.confidence > Confidence::Unsure)
    };
    // mm/s and m/s, but nothing between.
    assert!(velocity_of(1.0) && velocity_of(1e-3));
    assert!(!velocity_of(1.0 / 58.0));
}

#[test]
fn columns_of_one_heading_are_told_by_number() {
    let columns =
        [("t", 0.0, 1.0), ("Pressure [bar]", 90.0, 40.0), ("Pressure [bar]", 50.0, 30.0), ("x [mm]", 40.0, 9.0)];
    let (_folder, path) = swings(&columns);
    let guessed = guess(&path, "load").unwrap();
    let found: Vec<String> =
        pairs(&guessed).into_iter().map(|(signal, origin, _)| format!("{signal} {origin}")).collect();
    assert!(
        found.contains(&"load.cap_pressure 2".to_string()) && found.contains(&"load.rod_pressure 3".to_string()),
        "{found:?}"
    );
}

#[test]
fn a_column_that_is_nearly_empty_is_not_likely() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.csv");
    let mut text = "t,x [mm],F [kN]\n".to_string();
    for i in 0..1000 {
        let force = if i < 6 { "3.1" } else { "" };
        text += &format!("{},{},{force}\n", f64::from(i) * 1e-2, f64::from(i % 100));
    }
    std::fs::write(&path, text).unwrap();
    let guessed = guess(&path, "load").unwrap();
    let force = guessed.signals.iter().find(|found| found.source.signal.to_string() == "load.rod_force").unwrap();
    assert_eq!(force.confidence, Confidence::Unsure, "{}", force.reason);
    assert!(force.reason.contains("99.4 % of its cells are empty"), "{}", force.reason);
}

#[test]
fn a_rate_that_nobody_knows_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.csv");
    let mut text = "x [mm],p_A [bar]\n".to_string();
    (0..100).for_each(|i| text += &format!("{},{}\n", i % 7, i % 5));
    std::fs::write(&path, text).unwrap();
    let guessed = guess(&path, "load").unwrap();
    let text = guessed.to_text().unwrap();
    assert!(text.contains("\n# rate = 500.0 ") && text.contains("no time found"), "{text}");
    let asked = read_mapped(&path, &text.parse().unwrap()).unwrap_err().to_string();
    assert!(asked.contains("or `rate` in samples per second"), "{asked}");
    assert!(read_mapped(&path, &guessed.map()).is_err());
}
