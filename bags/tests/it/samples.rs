//! The sample recordings: small, readable, and all the same.

use crate::support;
use std::path::{Path, PathBuf};

use excavator_bags::map::{Origin, read_recording_or_mapped};
use excavator_model::recording::Recording;

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(name)
}

fn read(name: &str) -> Recording {
    let (recording, report) = read_recording_or_mapped(&sample(name), Origin::default()).unwrap();
    assert_eq!(report.problems(), Vec::<String>::new(), "{name}");
    recording.validate().unwrap();
    recording
}

fn size(path: &Path) -> u64 {
    if path.is_dir() {
        return std::fs::read_dir(path).unwrap().map(|entry| size(&entry.unwrap().path())).sum();
    }
    path.metadata().unwrap().len()
}

#[test]
fn each_is_small() {
    for name in ["arm-swing", "joint-states", "arm-swing.csv"] {
        assert!(size(&sample(name)) < 200_000, "{name}: {} bytes", size(&sample(name)));
    }
}

#[test]
fn bag_table_and_foreign_topics_are_the_same_recording() {
    let bag = read("arm-swing");
    assert_eq!((bag.len(), bag.cylinders.len()), (501, 1));
    support::assert_equal(&read("arm-swing.csv"), &bag);
    let foreign = read("joint-states");
    assert_eq!((&foreign.time, foreign.start_nanoseconds), (&bag.time, bag.start_nanoseconds));
    for ((name, found), (expected_name, expected)) in foreign.signals().into_iter().zip(bag.signals()) {
        assert_eq!(name, expected_name);
        let range = expected.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
        for (sample, (found, expected)) in found.iter().zip(expected).enumerate() {
            // The pump has half the samples: lines between them are 2 % of its swing away where it turns.
            let tolerance = if name == "pump_pressure" { 0.1 * range } else { 1e-9 * range };
            let same = (found - expected).abs() <= tolerance || (found.is_nan() && expected.is_nan());
            assert!(same, "{name}, sample {sample}: {found} instead of {expected}");
        }
    }
}
