//! What is odd in a recording but no reason to refuse it is told, in one line on standard error; what is not odd draws no line.

use std::path::Path;

use crate::common::{assert_one_clear_line, complaint, excavator};
use excavator_bags::{Topics, write_recording};
use excavator_model::recording::Recording;
use rosbag2::WriteOptions;

/// A swinging arm, and a second cylinder that rests, after `change`.
fn swinging(change: impl Fn(&mut Recording)) -> Recording {
    let time: Vec<f64> = (0..2500).map(|index| f64::from(index) * 0.002).collect();
    let mut recording = Recording::unmeasured("swinging", time, &["arm", "boom"]);
    recording.tank_pressure.fill(1e5);
    recording.pump_flow.fill(3.8e-4);
    for index in 0..recording.len() {
        let swing = (3.0 * recording.time[index]).sin();
        recording.pump_pressure[index] = 1.5e6 + 1e5 * swing.abs();
        recording.cylinders[1].displacement[index] = 0.1;
        let arm = &mut recording.cylinders[0];
        arm.displacement[index] = 0.05 * swing;
        arm.cap_pressure[index] = 1e6 + 2e5 * swing;
        arm.rod_pressure[index] = 9e5 - 2e5 * swing;
        arm.orifice_area[index] = 5e-5 * swing;
        arm.orifice_command[index] = 5e-5 * (3.0 * (recording.time[index] + 0.1)).sin();
    }
    change(&mut recording);
    recording
}

fn compared(change: impl Fn(&mut Recording)) -> std::process::Output {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "bag", &swinging(change));
    excavator(folder.path(), &["compare", "--model", "zx30u-arm", "--bag", "bag"])
}

fn write(folder: &Path, name: &str, recording: &Recording) {
    write_recording(&folder.join(name), recording, &Topics::default(), &WriteOptions::default()).unwrap();
}

/// The recording is used, and this is said about it.
fn is_told(change: impl Fn(&mut Recording), parts: &[&str]) {
    let output = compared(change);
    let told = complaint(&output);
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(told.lines().any(|line| parts.iter().all(|part| line.contains(part))), "{parts:?} not in: {told}");
}

#[test]
fn an_ordinary_recording_draws_no_line() {
    let output = compared(|_| ());
    assert_eq!((output.status.code(), complaint(&output).as_str()), (Some(0), ""));
}

#[test]
fn one_sensor_in_two_places_is_refused() {
    let output = compared(|recording| {
        let arm = &mut recording.cylinders[0];
        arm.rod_pressure.clone_from(&arm.cap_pressure);
    });
    assert_one_clear_line(&output, &["arm.cap_pressure and arm.rod_pressure are the same signal"]);
}

#[test]
fn a_valve_that_opens_beyond_its_maximum_is_told() {
    let factor = 1.5 * 1.15e-4 / 5e-5;
    is_told(
        |recording| recording.cylinders[0].orifice_area.iter_mut().for_each(|area| *area *= factor),
        &["arm.orifice_area reaches 172", "1.50 times the full command of zx30u-arm"],
    );
}

#[test]
fn a_command_that_is_not_followed_is_told() {
    is_told(
        |recording| recording.cylinders[0].orifice_command.iter_mut().for_each(|area| *area *= -1.0),
        &["arm: the spool does not follow its command", "check sign, clock and topic"],
    );
}

#[test]
fn readings_beyond_anything_possible_are_told() {
    is_told(
        |recording| recording.cylinders[0].cap_pressure[700..705].fill(4.2e9),
        &["arm.cap_pressure: 5 of 2500 readings are beyond anything possible", "4.200e9 Pa"],
    );
}

#[test]
fn a_single_reading_far_from_its_neighbours_is_left_out_and_told() {
    let told = complaint(&compared(|recording| recording.cylinders[0].cap_pressure[700] = 4.2e9));
    let line = "arm.cap_pressure: one value jumps away from its neighbours and back, at 1.400 s to 4.2000e9 Pa; it is left out";
    assert!(told.contains(line), "{told}");
    assert!(!told.contains("beyond anything possible"), "{told}");
}

#[test]
fn a_cylinder_that_the_model_does_not_have_is_told_where_it_moves() {
    is_told(
        |recording| recording.cylinders[1].displacement[1000..].fill(0.3),
        &["cylinder boom moves by 0.200 m but is not in zx30u-arm"],
    );
}

#[test]
fn a_recording_that_judges_its_own_fit_or_counts_twice_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "bag", &swinging(|_| ()));
    let told = |bags: &[&str]| {
        let words = ["refine", "--model", "zx30u-arm", "-o", "m.toml", "--force", "--add", "payload"];
        let done = excavator(folder.path(), &[&words[..], bags].concat());
        (done.status.code(), complaint(&done))
    };
    let line = "100 % of the readings of bag are also in bag; fitted data cannot serve as evidence";
    let same = ["--identification", "bag", "--validation", "bag"];
    let (code, refused) = told(&same);
    assert!(code == Some(1) && refused.contains(line) && refused.contains("--accept shared-readings"), "{refused}");
    let (_, accepted) = told(&[&same[..], &["--accept", "shared-readings"]].concat());
    assert!(accepted.contains(line) && !accepted.contains("--accept"), "{accepted}");
    let (code, twice) = told(&["--identification", "bag@0..3", "bag@0..3", "--validation", "bag@3..5"]);
    assert!(code == Some(1) && twice.contains("they would count twice"), "{twice}");
    let words = ["identify", "--model", "zx30u-arm", "--bag", "bag", "bag"];
    let again = complaint(&excavator(folder.path(), &words));
    assert!(again.contains("they would count twice"), "{again}");
    let (_, apart) = told(&["--identification", "bag@0..3", "--validation", "bag@3..5"]);
    assert!(!apart.contains("readings of"), "{apart}");
}

#[test]
fn a_piston_that_is_pressed_against_something_is_told() {
    let held = |recording: &mut Recording| {
        let arm = &mut recording.cylinders[0];
        // Something stands in the way at 30 mm.
        arm.displacement.iter_mut().for_each(|position| *position = position.min(0.03));
    };
    is_told(held, &["arm is pressed against something at +30.0 mm", "--where"]);
}

/// What a condition leaves out is simulated through and not compared.
#[test]
fn a_condition_leaves_samples_out() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "bag", &swinging(|_| ()));
    let compare = |condition: &str| {
        let words = ["compare", "--model", "zx30u-arm", "--bag", "bag", "--where", condition, "--json", "-"];
        excavator(folder.path(), &words)
    };
    let some = compare("abs(v) > 0.05");
    let told = complaint(&some);
    assert_eq!(some.status.code(), Some(0), "{told}");
    assert!(told.contains("% of the time is left out, where not abs(v) > 0.05"), "{told}");
    let found: serde_json::Value = serde_json::from_slice(&some.stdout).unwrap();
    let phases = found["signals"]["arm.displacement"]["phases"].as_array().unwrap();
    assert!(phases.iter().all(|phase| phase["phase"] == "moving"), "{phases:?}");
    assert_one_clear_line(&compare("abs(w) > 0.05"), &["--where \"abs(w) > 0.05\"", "unknown name \"w\""]);
    assert_one_clear_line(&compare("v"), &["expected a comparison"]);
}
