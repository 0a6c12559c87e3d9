//! Recordings of more than three minutes: the stretches that tell most, and parts of them.

use crate::common::{assert_one_clear_line, excavator, json};
use excavator_bags::{Topics, write_recording};
use excavator_model::document::built_in;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use rosbag2::WriteOptions;

/// Eight minutes of the arm at 500 Hz, which is two blocks of a reader, with noise: mostly small slow swings, now and then large ones.
fn eight_minutes() -> Recording {
    let model = built_in("zx30u-arm").unwrap();
    let time: Vec<f64> = (0..240_000).map(|index| f64::from(index) * 2e-3).collect();
    let mut recording = Recording::unmeasured("long", time, &["arm"]);
    recording.tank_pressure.fill(3e5);
    recording.pump_flow.fill(3.8e-4);
    let area = |t: &f64| {
        let large = if (t / 40.0).fract() < 0.2 { 6e-5 } else { 0.5e-5 };
        large * (3.1 * t).sin() + 0.4 * large * (8.3 * t).sin()
    };
    recording.cylinders[0].orifice_area = recording.time.iter().map(area).collect();
    let mut run = simulate_from_rest(&model, &recording, &[0.0], Tolerances::default()).unwrap();
    run.cylinders[0].velocity.fill(f64::NAN);
    run.cylinders[0].joint_angle.fill(f64::NAN);
    let mut chance = ChaCha8Rng::seed_from_u64(5);
    let mut add = |column: &mut Vec<f64>, size: f64| {
        let noise = Normal::new(0.0, size).unwrap();
        column.iter_mut().for_each(|value| *value += noise.sample(&mut chance));
    };
    add(&mut run.cylinders[0].displacement, 5e-5);
    add(&mut run.cylinders[0].cap_pressure, 2e3);
    add(&mut run.cylinders[0].rod_pressure, 2e3);
    add(&mut run.pump_pressure, 2e3);
    run
}

/// Value and 95 % margin of the viscous damping.
fn damping(result: &serde_json::Value) -> [f64; 2] {
    let parameters = result["parameters"].as_array().unwrap();
    let own = parameters.iter().find(|one| one["name"] == "arm.viscous_damping").unwrap();
    [own["value"].as_f64().unwrap(), 1.96 * own["std_error"].as_f64().unwrap()]
}

#[test]
fn the_stretches_that_tell_most_stand_for_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    write_recording(&folder.path().join("bag"), &eight_minutes(), &Topics::default(), &WriteOptions::default())
        .unwrap();
    let identify = |bag: &str, more: &[&str]| {
        let words = [&["identify", "--model", "zx30u-arm", "--json", "-", "--bag", bag], more].concat();
        let output = excavator(folder.path(), &words);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (damping(&json(&output)), said)
    };
    let ([value, margin], said) = identify("bag", &[]);
    assert!(said.contains("96 of 480 s are used") && said.contains("--whole uses all"), "{said}");
    let truth = 13_000.0;
    assert!((value - truth).abs() < 1.5 * margin && margin < 0.03 * truth, "{value} ± {margin}");
    let ([of_whole, of_whole_margin], said) = identify("bag", &["--whole"]);
    assert!(!said.contains("are used"), "{said}");
    assert!((of_whole - value).abs() < margin + of_whole_margin, "{of_whole} {value} ± {margin}");
    assert!(margin < 4.0 * of_whole_margin, "{margin} {of_whole_margin}");
    // A part that lies across two blocks is one recording.
    let ([of_part, part_margin], said) = identify("bag@330..390", &[]);
    assert!(!said.contains("are used"), "{said}");
    assert!((of_part - truth).abs() < 1.5 * part_margin, "{of_part} ± {part_margin}");
    let output = excavator(folder.path(), &["identify", "--model", "zx30u-arm", "--bag", "bag@500..510"]);
    assert_one_clear_line(&output, &["bag@500..510", "ends at 480.00 s"]);
}
