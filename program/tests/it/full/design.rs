//! From a tie to a name: `diagnose` leaves a tie, `design` proposes a profile, and under that profile `diagnose` separates it.

use std::path::{Path, PathBuf};

use crate::common::{assert_one_clear_line, complaint, excavator, json};
use excavator_bags::{Topics, read_recording, write_recording};
use excavator_model::Model;
use excavator_model::document::{built_in, to_text};
use excavator_model::recording::Recording;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use rosbag2::WriteOptions;
use serde_json::Value;

/// A machine with a hidden effect, and the parameters of the model's own up to 12 % off.
fn machine(effect: &str, values: &[(&str, f64)]) -> Model {
    let mut model = built_in("zx30u-arm").unwrap();
    for (number, parameter) in model.parameters_mut().filter(|parameter| !parameter.known).enumerate() {
        parameter.value *= [1.08, 0.93, 1.12, 0.95, 1.05, 0.9][number % 6];
    }
    let (physics, site) = model.parse_addition(effect).unwrap().remove(0);
    let mut model = model.with_effect(&physics, site).unwrap();
    for (name, value) in values {
        let added = model.effects.last_mut().unwrap();
        added.parameters.iter_mut().find(|parameter| parameter.card.name == *name).unwrap().value = *value;
    }
    model
}

/// Two noisy recordings of the machine under a profile.
fn record(folder: &Path, machine: &Path, profile: &Path, name: &str, seed: u64) -> [PathBuf; 2] {
    let clean = folder.join(format!("{name}-clean"));
    let words = ["simulate", "--model", machine.to_str().unwrap(), "--input", profile.to_str().unwrap(), "-o"];
    let output = excavator(folder, &[&words[..], &[clean.to_str().unwrap()]].concat());
    assert!(output.status.success(), "{}", complaint(&output));
    let (recording, _) = read_recording(&clean, &Topics::default()).unwrap();
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    ["identification", "validation"].map(|part| {
        let mut noisy = recording.thinned(2);
        disturb(&mut noisy, &mut generator);
        let path = folder.join(format!("{name}-{part}"));
        write_recording(&path, &noisy, &Topics::default(), &WriteOptions::default()).unwrap();
        path
    })
}

/// Sensors as in the practice recordings: 0.05 mm, 2 kPa, 2e-7 m²; no sensor of speed or angle.
fn disturb(recording: &mut Recording, generator: &mut ChaCha8Rng) {
    let mut add = |values: &mut [f64], deviation: f64| {
        let noise = Normal::new(0.0, deviation).unwrap();
        values.iter_mut().for_each(|value| *value += noise.sample(generator));
    };
    let arm = &mut recording.cylinders[0];
    add(&mut arm.displacement, 5e-5);
    add(&mut arm.cap_pressure, 2e3);
    add(&mut arm.rod_pressure, 2e3);
    add(&mut arm.orifice_area, 2e-7);
    arm.velocity.fill(f64::NAN);
    arm.joint_angle.fill(f64::NAN);
    add(&mut recording.pump_pressure, 2e3);
}

fn diagnose(folder: &Path, bags: &[PathBuf; 2], result: &str) -> Value {
    let words = ["diagnose", "--model", "zx30u-arm", "--json", result];
    let recordings = ["--identification", bags[0].to_str().unwrap(), "--validation", bags[1].to_str().unwrap()];
    let output = excavator(folder, &[&words[..], &recordings].concat());
    assert!(output.status.success(), "{}", complaint(&output));
    serde_json::from_str(&std::fs::read_to_string(folder.join(result)).unwrap()).unwrap()
}

/// Names of the first candidate and of those tied with it.
fn named(diagnosis: &Value) -> Vec<String> {
    let candidates = diagnosis["candidates"].as_array().unwrap();
    candidates
        .iter()
        .enumerate()
        .filter(|(position, one)| *position == 0 || one["tied_with_first"] == true)
        .map(|(_, one)| one["effect"].as_str().unwrap().to_string())
        .collect()
}

struct Story {
    before: Vec<String>,
    design: Value,
    after: Vec<String>,
    after_verdict: String,
}

/// The whole way for one hidden effect. `others`: rivals where the diagnosis of the sines leaves no tie.
fn story(effect: &str, values: &[(&str, f64)], profile: &str, others: &str, duration: &str) -> Story {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let truth = folder.join("truth.toml");
    std::fs::write(&truth, to_text(&machine(effect, values)).unwrap()).unwrap();
    let sines = folder.join("sines.toml");
    std::fs::write(&sines, profile).unwrap();
    let before = diagnose(folder, &record(folder, &truth, &sines, "sines", 11), "before.json");
    println!("{effect} under sines: {} {:?}", before["verdict"], named(&before));

    let mut words = vec!["design", "--model", "zx30u-arm", "--diagnosis", "before.json", "--duration", duration];
    words.extend(["-o", "proposed.toml", "--json", "-"]);
    if named(&before).len() < 2 {
        words.extend(["--between", others]);
    }
    let design = json(&excavator(folder, &words));
    for pair in design["pairs"].as_array().unwrap() {
        println!(
            "  {} and {}: distance {:.0}, linear improvement {:.2}, expected improvement {:.2}, significance {:.1}",
            pair["first"],
            pair["second"],
            pair["distance"].as_f64().unwrap(),
            pair["linear_improvement"].as_f64().unwrap(),
            pair["expected_improvement"].as_f64().unwrap(),
            pair["expected_significance"].as_f64().unwrap()
        );
    }
    println!("  {}", design["plan"]);
    let proposed = folder.join("proposed.toml");
    let after = diagnose(folder, &record(folder, &truth, &proposed, "proposed", 12), "after.json");
    println!("  under the proposed profile: {} {:?}", after["verdict"], named(&after));
    let gains = after["candidates"].as_array().unwrap().iter().chain(after["rejected"].as_array().unwrap());
    let gains: Vec<(String, f64)> =
        gains.map(|one| (one["effect"].as_str().unwrap().into(), one["evidence"].as_f64().unwrap())).collect();
    println!("  gains: {gains:.2?}");
    Story {
        before: named(&before),
        design,
        after: named(&after),
        after_verdict: after["verdict"].as_str().unwrap().into(),
    }
}

/// Sines of moderate size: what an operator records who has not thought of effects.
const SHORT_SINES: &str = r#"
rate = 1000.0
[[profiles]]
cylinder = "arm"
segments = [
    { kind = "hold", duration = 0.5, area = 0.0 },
    { kind = "sine", duration = 6.0, amplitude = 6e-5, frequency = 0.25 },
    { kind = "sine", duration = 6.6667, amplitude = 4e-5, frequency = 0.3 },
]
"#;

/// A short lag of the valve leaves no name under slow sines: it is below what a diagnosis acts on, like late sensors. Under
/// the proposed profile it is named, alone.
#[test]
fn a_tie_is_separated_by_the_proposed_profile() {
    let story = story("valve_lag@arm", &[("lag_time", 0.006)], SHORT_SINES, "valve_lag@arm,sensor_delay@arm", "20");
    assert_ne!(story.before, ["valve_lag"], "the sines must leave it open");
    assert_eq!(story.design["all_separated"], true, "{}", story.design["pairs"]);
    let duration = &story.design["plan"]["duration"];
    assert!(duration.as_f64().unwrap() <= 20.0, "{duration}");
    assert_eq!((story.after_verdict.as_str(), story.after), ("missing_effect", vec!["valve_lag".to_string()]));
}

#[test]
fn bad_input_is_one_clear_line() {
    let folder = tempfile::tempdir().unwrap();
    let design = |words: &[&str]| {
        excavator(folder.path(), &[&["design", "--model", "zx30u-arm", "-o", "p.toml"][..], words].concat())
    };
    let output = design(&["--between", "valve_dead_zone,hysteresis"]);
    assert_one_clear_line(&output, &["unknown effect \"hysteresis\"", "did you mean"]);
    let output = design(&["--between", "valve_dead_zone,valve_dead_zone@arm"]);
    assert_one_clear_line(&output, &["valve_dead_zone@arm is named twice"]);
    assert_one_clear_line(&design(&["--parameter", "arm.inertai"]), &["did you mean \"arm.inertia\"?"]);
    assert_one_clear_line(&design(&["--parameter", "arm.vapour_pressure"]), &["known constant"]);
    assert_one_clear_line(&design(&["--diagnosis", "nowhere.json"]), &["nowhere.json"]);
    std::fs::write(folder.path().join("odd.json"), "{}").unwrap();
    assert_one_clear_line(&design(&["--diagnosis", "odd.json"]), &["odd.json", "verdict"]);

    let alone = design(&["--between", "valve_dead_zone"]);
    assert_eq!(alone.status.code(), Some(2));
    assert!(complaint(&alone).contains("valve_dead_zone@arm alone has nothing to be told from"));
    for words in
        [&["--between", "hose_loss,none", "--duration", "5"][..], &["--between", "a,b", "--duration", "x"], &[]]
    {
        assert_eq!(design(words).status.code(), Some(2), "{words:?}");
    }
    assert!(!folder.path().join("p.toml").exists());
}

#[test]
fn a_drive_without_a_valve_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["design", "--model", "emps", "-o", "p.toml", "--between", "stribeck_friction,hose_loss"];
    assert_one_clear_line(&excavator(folder.path(), &words), &["emps", "no valve"]);
}
