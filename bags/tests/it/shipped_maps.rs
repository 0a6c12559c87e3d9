//! The maps in `config/maps` on the files that they are for.

use std::path::{Path, PathBuf};

use crate::support::{assert_equal, shared};
use excavator_bags::map::{TopicMap, read_mapped};
use excavator_bags::{Topics, read_recording, write_recording};
use excavator_model::recording::{Recording, is_measured};
use rosbag2::WriteOptions;

fn map(name: &str) -> TopicMap {
    TopicMap::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../config/maps").join(name)).unwrap()
}

fn measured(recording: &Recording) -> Vec<String> {
    recording.signals().into_iter().filter(|(_, values)| is_measured(values)).map(|(name, _)| name).collect()
}

#[test]
fn every_shipped_map_is_a_map_and_survives_the_round_trip() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../config/maps");
    let files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(files.len() >= 3);
    for file in files {
        let map = TopicMap::read(&file).unwrap();
        assert_eq!(map.to_text().unwrap().parse::<TopicMap>().unwrap(), map, "{}", file.display());
    }
}

/// The bags of the benchmark were made with stamps of double precision since the epoch: exact to 128 ns.
#[test]
fn emps_from_its_matlab_files_is_emps_from_its_bags() {
    let Some(folder) = shared("realdata/emps") else { return };
    for (file, bag) in [("DATA_EMPS.mat", "identification"), ("DATA_EMPS_PULSES.mat", "validation")] {
        let (imported, report) = read_mapped(&folder.join(file), &map("emps.toml")).unwrap();
        assert_eq!(report.problems(), Vec::<String>::new());
        let (expected, _) = read_recording(&folder.join(bag), &Topics::default()).unwrap();
        assert_eq!((imported.len(), imported.start_nanoseconds), (expected.len(), expected.start_nanoseconds));
        let latest = imported.time.iter().zip(&expected.time).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(latest <= 129e-9, "stamps differ by up to {latest} s");
        let (a, b) = (&imported.cylinders[0], &expected.cylinders[0]);
        assert_eq!((&a.name, &a.displacement, &a.rod_force), (&b.name, &b.displacement, &b.rod_force));
        assert_eq!(measured(&imported), measured(&expected));
        println!("{file}: {} samples equal bit for bit, stamps within {:.0} ns", imported.len(), latest * 1e9);
    }
}

#[test]
fn an_imported_table_written_as_a_bag_reads_back_the_same() {
    let Some(file) = shared("realdata/emps/DATA_EMPS.mat") else { return };
    let (imported, _) = read_mapped(&file, &map("emps.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("emps");
    write_recording(&bag, &imported, &Topics::default(), &WriteOptions::default()).unwrap();
    let (read, report) = read_recording(&bag, &Topics::default()).unwrap();
    assert_eq!(report.damage, []);
    assert_equal(&read, &imported);
}

#[test]
fn every_table_of_seal_friction_is_read() {
    let Some(folder) = shared("realdata/cylinder_seal_friction") else { return };
    let map = map("seal-friction.toml");
    let mut tables = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let Some(pressure) = name.strip_suffix("bar.csv").and_then(|name| name.rsplit_once('_')).map(|(_, p)| p) else {
            continue;
        };
        let (recording, report) = read_mapped(&path, &map).unwrap();
        recording.validate().unwrap();
        assert_eq!(report.notes, Vec::<String>::new(), "{name}");
        assert!((recording.sample_interval() - 0.0105).abs() < 0.001, "{name} {}", recording.sample_interval());
        let load = &recording.cylinders[0];
        let nominal: f64 = pressure.parse::<f64>().unwrap() * 1e5;
        let median = {
            let mut sorted = load.cap_pressure.clone();
            sorted.sort_by(f64::total_cmp);
            sorted[sorted.len() / 2]
        };
        assert!((median - nominal).abs() < 0.05e5 + 0.05 * nominal, "{name}: {median} Pa");
        assert!(load.displacement.iter().all(|s| s.abs() < 0.03), "{name}");
        // What the testing machine does not carry, pressure and friction do: about 25 mm of piston.
        let area = std::f64::consts::PI / 4.0 * 0.0253f64.powi(2);
        let friction: Vec<f64> =
            load.cap_pressure.iter().zip(&load.rod_force).map(|(p, force)| p * area + force).collect();
        let mean = friction.iter().sum::<f64>() / friction.len() as f64;
        assert!(mean.abs() < 25.0, "{name}: {mean} N");
        tables += 1;
    }
    assert_eq!(tables, 12);
}

#[test]
fn the_crane_actuator_is_read_from_its_matlab_4_file() {
    let Some(file) = shared("realdata/sjoberg_hydraulic_actuator/actuator.mat") else { return };
    let (recording, report) = read_mapped(&file, &map("sjoberg-actuator.toml")).unwrap();
    // The position of row 987 is 1.740 between 1.603 and 1.613.
    let [spike] = &report.problems()[..] else { panic!("{:?}", report.problems()) };
    assert!(spike.starts_with("arm.displacement: one value jumps away") && spike.contains("9.860 s"), "{spike}");
    assert_eq!(recording.len(), 1024);
    let arm = &recording.cylinders[0];
    let range = |values: &[f64]| values.iter().fold((f64::MAX, f64::MIN), |(a, b), &v| (a.min(v), b.max(v)));
    // The extremes of the file, as any other reader of it has them.
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9 * expected.abs(), "{found}");
    near(range(&arm.cap_pressure).0, -3.96435668e6);
    near(range(&arm.cap_pressure).1, 3.517387476e6);
    near(range(&arm.orifice_command).1, 1.45457e-4);
    near(range(&arm.displacement).1, 0.236982);
    // A positive command lets the position grow.
    let speed: Vec<f64> = arm.displacement.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let product: f64 = speed.iter().skip(5).zip(&arm.orifice_command).map(|(speed, command)| speed * command).sum();
    assert!(product > 0.0);
}
