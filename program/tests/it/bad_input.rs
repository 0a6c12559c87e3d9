//! Bad input: one clear line each, the exit status of the contract, never a panic.

use std::path::{Path, PathBuf};

use crate::common::{assert_one_clear_line, complaint, excavator};
use excavator::demo::{manoeuvre, plant, sealed::Sealed};
use excavator_bags::{Topics, write_recording};
use excavator_model::recording::Recording;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rosbag2::WriteOptions;

/// A short recording of an arm that swings, written as a bag after `change`.
fn bag(folder: &Path, name: &str, change: impl Fn(&mut Recording)) -> PathBuf {
    let time: Vec<f64> = (0..2500).map(|index| f64::from(index) * 0.002).collect();
    let mut recording = Recording::unmeasured(name, time, &["arm"]);
    recording.tank_pressure.fill(1e5);
    recording.pump_flow.fill(3.8e-4);
    for index in 0..recording.len() {
        let swing = (3.0 * recording.time[index]).sin();
        let arm = &mut recording.cylinders[0];
        arm.displacement[index] = 0.05 * swing;
        arm.cap_pressure[index] = 1e6 + 2e5 * swing;
        arm.rod_pressure[index] = 9e5 - 2e5 * swing;
        arm.orifice_area[index] = 5e-5 * swing;
        arm.orifice_command[index] = 5e-5 * swing;
        recording.pump_pressure[index] = 1.5e6 + 1e5 * swing.abs();
    }
    change(&mut recording);
    let path = folder.join(name);
    write_recording(&path, &recording, &Topics::default(), &WriteOptions::default()).unwrap();
    path
}

fn compare(folder: &Path, model: &str, bag: &Path) -> std::process::Output {
    excavator(folder, &["compare", "--model", model, "--bag", bag.to_str().unwrap()])
}

#[test]
fn unknown_model_says_what_was_meant() {
    let folder = tempfile::tempdir().unwrap();
    let bag = bag(folder.path(), "good", |_| ());
    let output = compare(folder.path(), "zx30-arm", &bag);
    assert_one_clear_line(&output, &["unknown model \"zx30-arm\"", "did you mean \"zx30u-arm\"?"]);
}

#[test]
fn unknown_effect_says_what_was_meant() {
    let folder = tempfile::tempdir().unwrap();
    assert_one_clear_line(
        &excavator(folder.path(), &["effects", "stribeck"]),
        &["unknown effect \"stribeck\"", "did you mean \"stribeck_friction\"?"],
    );
    let words =
        ["refine", "--model", "zx30u-arm", "--identification", "a", "--validation", "b", "-o", "m.toml", "--add"];
    let output = excavator(folder.path(), &[&words[..], &["dead_zone"]].concat());
    assert_one_clear_line(&output, &["unknown effect \"dead_zone\"", "valve_dead_zone"]);
}

#[test]
fn wrong_usage_is_status_two() {
    let folder = tempfile::tempdir().unwrap();
    for words in
        [&["compare"][..], &["dance"], &["identify", "--model", "zx30u-arm", "--bag", "x", "--method", "magic"]]
    {
        assert_eq!(excavator(folder.path(), words).status.code(), Some(2), "{words:?}");
    }
}

#[test]
fn missing_bag_and_foreign_folder() {
    let folder = tempfile::tempdir().unwrap();
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", Path::new("nowhere")), &["nowhere"]);
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", Path::new("empty")), &["empty"]);
}

#[test]
fn truncated_bag_is_read_to_the_last_good_chunk_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let whole = bag(folder.path(), "whole", |_| ());
    let bytes = std::fs::read(whole.join("whole_0.mcap")).unwrap();
    let cut = folder.path().join("cut.mcap");
    std::fs::write(&cut, &bytes[..bytes.len() * 2 / 3]).unwrap();
    let output = compare(folder.path(), "zx30u-arm", &cut);
    let complaint = complaint(&output);
    assert!(!complaint.contains("panicked"), "{complaint}");
    assert!(complaint.contains("lost") || complaint.contains("cut off") || complaint.contains("bytes"), "{complaint}");
}

#[test]
fn garbage_is_no_bag() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("garbage.mcap");
    std::fs::write(&path, [0x5a; 4096]).unwrap();
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", &path), &["garbage.mcap"]);
}

#[test]
fn too_short() {
    let folder = tempfile::tempdir().unwrap();
    let path = bag(folder.path(), "short", |recording| *recording = recording.thinned(400));
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", &path), &["too short"]);
}

#[test]
fn no_motion_invents_no_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = bag(folder.path(), "still", |recording| recording.cylinders[0].displacement.fill(0.1));
    for words in [
        &["identify", "--model", "zx30u-arm", "--json", "-", "--bag"][..],
        &["compare", "--model", "zx30u-arm", "--bag"],
    ] {
        let output = excavator(folder.path(), &[words, &[path.to_str().unwrap()]].concat());
        assert_one_clear_line(&output, &["no motion", "arm.displacement"]);
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn nothing_measured() {
    let folder = tempfile::tempdir().unwrap();
    let path = bag(folder.path(), "nothing", |recording| {
        *recording = Recording::unmeasured("nothing", recording.time.clone(), &["arm"]);
    });
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", &path), &["arm.displacement", "NaN"]);
}

#[test]
fn another_machine_says_which_cylinders_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = bag(folder.path(), "arm", |_| ());
    assert_one_clear_line(&compare(folder.path(), "zx30u", &path), &["boom", "arm"]);
}

#[test]
fn wrong_units() {
    let folder = tempfile::tempdir().unwrap();
    let path = bag(folder.path(), "millimetres", |recording| {
        recording.cylinders[0].displacement.iter_mut().for_each(|s| *s *= 1e3);
    });
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", &path), &["arm.displacement", "is it in m?"]);
    // A sensor that counts from the retracted end of the 600 mm stroke; a map without its offset.
    let path = bag(folder.path(), "extension", |recording| {
        recording.cylinders[0].displacement.iter_mut().for_each(|s| *s = 8.0 * *s + 0.3);
    });
    let parts = ["from -0.100 m to 0.700 m", "only from -0.300 m to 0.300 m", "mid-stroke", "\"-300 mm\""];
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", &path), &parts);
    // One that is a little off is for the diagnosis.
    let path = bag(folder.path(), "offset", |recording| {
        recording.cylinders[0].displacement.iter_mut().for_each(|s| *s += 0.28);
    });
    assert!(compare(folder.path(), "zx30u-arm", &path).status.success());
    let path = bag(folder.path(), "bar", |recording| {
        recording.cylinders[0].cap_pressure.iter_mut().for_each(|p| *p *= 1e-5);
    });
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", &path), &["arm.cap_pressure", "bar"]);
    let path = bag(folder.path(), "kilopascal", |recording| {
        let arm = &mut recording.cylinders[0];
        for pressures in [&mut arm.cap_pressure, &mut arm.rod_pressure] {
            pressures.iter_mut().for_each(|value| *value /= 1e3);
        }
    });
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", &path), &["arm.cap_pressure", "kPa"]);
    let path = bag(folder.path(), "kilopascal-pump", |recording| {
        recording.pump_pressure.iter_mut().for_each(|value| *value /= 1e3);
    });
    assert_one_clear_line(&compare(folder.path(), "zx30u-arm", &path), &["pump_pressure", "kPa"]);
    let path = bag(folder.path(), "open-rod-side", |recording| {
        recording.cylinders[0].rod_pressure.iter_mut().for_each(|value| *value /= 1e2);
    });
    assert!(compare(folder.path(), "zx30u-arm", &path).status.success(), "a side at 0.1 bar is no wrong unit");
}

#[test]
fn sensors_that_are_stuck_or_cut_off() {
    let folder = tempfile::tempdir().unwrap();
    let stuck = bag(folder.path(), "stuck", |recording| {
        let held = recording.cylinders[0].rod_pressure[1000];
        recording.cylinders[0].rod_pressure[1000..2000].fill(held);
    });
    assert_one_clear_line(
        &compare(folder.path(), "zx30u-arm", &stuck),
        &["arm.rod_pressure stands still", "from 2.00 s to 4.00 s", "BAG@FROM..TO"],
    );
    let cut = bag(folder.path(), "cut", |recording| {
        recording.cylinders[0].cap_pressure.iter_mut().for_each(|value| *value = value.min(1.15e6));
    });
    assert_one_clear_line(
        &compare(folder.path(), "zx30u-arm", &cut),
        &["arm.cap_pressure is cut off at 1.15", "range"],
    );
}

#[test]
fn chambers_whose_sensors_are_swapped() {
    let folder = tempfile::tempdir().unwrap();
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let sealed = Sealed::draw_without_effect(&mut generator).unwrap();
    let mut recording = plant::record(&sealed, &manoeuvre::validation(), &mut generator).unwrap();
    let write = |name: &str, recording: &Recording| {
        let path = folder.path().join(name);
        write_recording(&path, recording, &Topics::default(), &WriteOptions::default()).unwrap();
        compare(folder.path(), "zx30u-arm", &path)
    };
    assert_eq!(write("right", &recording).status.code(), Some(0));
    let arm = &mut recording.cylinders[0];
    std::mem::swap(&mut arm.cap_pressure, &mut arm.rod_pressure);
    let wanted = ["cap_pressure and rod_pressure of arm look swapped", "say --accept swapped-pressures"];
    assert_one_clear_line(&write("swapped", &recording), &wanted);
    // Whoever knows better has the last word, and is reminded of it.
    let bag = folder.path().join("swapped");
    let words = ["compare", "--model", "zx30u-arm", "--bag", bag.to_str().unwrap(), "--accept", "swapped-pressures"];
    let accepted = excavator(folder.path(), &words);
    assert_eq!(accepted.status.code(), Some(0));
    let told = String::from_utf8_lossy(&accepted.stderr).to_string();
    assert!(told.contains("accepted: ") && told.contains("look swapped"), "{told}");
}

#[test]
fn broken_model_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("broken.toml");
    std::fs::write(&path, "[machine]\nname = 3").unwrap();
    let bag = bag(folder.path(), "good", |_| ());
    assert_one_clear_line(&compare(folder.path(), path.to_str().unwrap(), &bag), &["broken.toml"]);
}

#[test]
fn broken_profile() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("profile.toml");
    for text in ["profiles = 3", "[[profiles]]\ncylinder = \"leg\"\nsegments = []", "rate = 0.0\nprofiles = []"] {
        std::fs::write(&path, text).unwrap();
        let words = ["simulate", "--model", "zx30u-arm", "--input", "profile.toml", "-o", "out"];
        assert_one_clear_line(&excavator(folder.path(), &words), &["profile"]);
    }
}
