//! The procedures of \[B\] on a simulated servo bench that hides a dead zone, play, unequal gains, leakage and friction: what
//! was hidden comes out, and recordings that do not suit are refused with the number that is missing.

use std::path::{Path, PathBuf};

use crate::common::{assert_one_clear_line, complaint, excavator, json};
use excavator_bags::{Topics, read_recording, write_recording};
use excavator_identification::characterisation::{Characterisation, Estimate, Refusal, characterise};
use excavator_model::Model;
use excavator_model::document::{built_in, to_text};
use excavator_model::effects::{Catalogue, Site};
use excavator_model::recording::Recording;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use rosbag2::WriteOptions;

/// Noise of displacement, chamber pressures, spool and load cell: m, Pa, m², N.
const NOISE: [f64; 4] = [2e-5, 2e3, 1e-7, 10.0];

/// Overlaps, play, gain changes, leakages, hose loss, Coulomb friction.
const HIDDEN: [(&str, &[f64]); 6] = [
    ("valve_hysteresis", &[2e-6]),
    ("valve_dead_zone", &[1.2e-5, 9e-6]),
    ("valve_directional_gain", &[8e-4, -6e-4]),
    ("valve_leakage", &[4e-13, 5e-13, 4e-13, 6e-13]),
    ("hose_loss", &[4e4]),
    ("coulomb_friction", &[600.0]),
];
const GAIN: f64 = 0.0046;
const VISCOUS: f64 = 1e4;
const MASS: f64 = 300.0;

fn bench(hidden: &[(&str, &[f64])]) -> Model {
    let mut model = built_in("servo-bench").unwrap();
    for (name, values) in hidden {
        model = model.with_effect(&Catalogue::built_in().find(name).unwrap(), Site::Cylinder(0)).unwrap();
        for (parameter, value) in model.effects.last_mut().unwrap().parameters.iter_mut().zip(*values) {
            parameter.value = *value;
        }
    }
    model
}

fn profile(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../config/profiles").join(name)
}

/// What the bench's instruments record of a campaign; the load cell reads inertia and weight of the load.
fn record(folder: &Path, plant: &Model, campaign: &str, seed: u64, load_cell: bool) -> Recording {
    let model = folder.join("plant.toml");
    std::fs::write(&model, to_text(plant).unwrap()).unwrap();
    let bag = folder.join(format!("{campaign}-{seed}"));
    let (model, input, output) = (model.to_str().unwrap(), profile(campaign), bag.to_str().unwrap());
    let words = ["simulate", "--model", model, "--input", input.to_str().unwrap(), "-o", output];
    let done = excavator(folder, &words);
    assert!(done.status.success(), "{}", complaint(&done));
    let (mut recording, _) = read_recording(&bag, &Topics::default()).unwrap();
    recording.source = campaign.to_string();
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut noisy = |values: &mut [f64], deviation: f64| {
        let noise = Normal::new(0.0, deviation).unwrap();
        values.iter_mut().for_each(|value| *value += noise.sample(&mut generator));
    };
    let time = recording.time.clone();
    let load = &mut recording.cylinders[0];
    let force: Vec<f64> = (0..time.len())
        .map(|index| {
            let (before, after) = (index.saturating_sub(1), (index + 1).min(time.len() - 1));
            let acceleration = (load.velocity[after] - load.velocity[before]) / (time[after] - time[before]);
            -MASS * (acceleration + 9.8)
        })
        .collect();
    if load_cell {
        load.rod_force = force;
        noisy(&mut load.rod_force, NOISE[3]);
    } else {
        load.rod_force.fill(f64::NAN);
    }
    noisy(&mut load.displacement, NOISE[0]);
    noisy(&mut load.cap_pressure, NOISE[1]);
    noisy(&mut load.rod_pressure, NOISE[1]);
    noisy(&mut load.orifice_area, NOISE[2]);
    load.velocity.fill(f64::NAN);
    load.joint_angle.fill(f64::NAN);
    recording
}

fn found(recordings: &[&Recording]) -> Characterisation {
    characterise(&built_in("servo-bench").unwrap(), recordings).remove(0)
}

/// Within a share of the true value, and within four standard errors.
fn assert_found(what: &str, estimate: Estimate, truth: f64, share: f64) {
    let (off, errors) = (estimate.value / truth - 1.0, (estimate.value - truth) / estimate.error);
    println!(
        "{what:36} {:10.4e} for {truth:10.4e}: {:+.2} %, {errors:+.1} standard errors",
        estimate.value,
        100.0 * off
    );
    assert!(off.abs() < share, "{what}");
    assert!(errors.abs() < 4.0, "{what}");
}

fn campaign(folder: &Path, plant: &Model, load_cell: bool) -> Vec<Recording> {
    let names = [
        "bench-trapezoids.toml",
        "bench-closed-valve.toml",
        "bench-sine-0.27.toml",
        "bench-sine-0.35.toml",
        "bench-sine-0.50.toml",
    ];
    (1..).zip(names).map(|(seed, name)| record(folder, plant, name, seed, load_cell)).collect()
}

#[test]
fn what_the_bench_hides_comes_out() {
    let folder = tempfile::tempdir().unwrap();
    let recordings = campaign(folder.path(), &bench(&HIDDEN), false);
    let found = found(&recordings.iter().collect::<Vec<_>>());
    let leakage = found.leakage.unwrap();
    let (cap, rod) = (leakage.cap.unwrap(), leakage.rod.unwrap());
    assert_found("leakage pump to cap side", cap.from_pump, 4e-13, 0.02);
    assert_found("leakage cap side to tank", cap.to_tank, 5e-13, 0.02);
    assert_found("leakage pump to rod side", rod.from_pump, 4e-13, 0.02);
    assert_found("leakage rod side to tank", rod.to_tank, 6e-13, 0.02);
    assert_found("static gain, cap side", cap.static_gain, 4.0 / 9.0, 0.01);
    // V+ at mid-stroke is 2e-4 m³ of pipes and half a stroke of 0.5 m.
    assert_found("time constant, cap side", cap.time_constant, (2e-4 + 0.25 * 0.003117) / (1e9 * 9e-13), 0.02);
    let overlaps = [1.2e-5, 1.2e-5, 9e-6, 9e-6];
    for ((edge, zone), overlap) in found.dead_zones.into_iter().zip(overlaps) {
        let zone = zone.unwrap();
        assert!(zone.runs.0 >= 30 && zone.runs.1 >= 20, "{:?}", zone.runs);
        assert_found(&format!("dead zone {}", edge.name()), zone.dead_zone, overlap, 0.02);
        assert_found(&format!("hysteresis {}", edge.name()), zone.hysteresis, 2e-6, 0.15);
    }
    let gains = [GAIN, GAIN, GAIN + 8e-4, GAIN - 6e-4];
    for ((edge, gain), truth) in found.gains.into_iter().zip(gains) {
        let gain = gain.unwrap();
        let past_edge = gain.past_edge.unwrap();
        assert!(gain.points.len() >= 16, "{}", gain.points.len());
        assert_eq!(past_edge.degree(), 0, "{}: {}", edge.name(), past_edge.reason);
        let value = Estimate { value: past_edge.at(0.5), error: past_edge.error_at(0.5) };
        assert_found(&format!("gain {}", edge.name()), value, truth, 0.01);
        // Counted from closed, the same gain is bent by the overlap and half the play: k = C (1 - dz/|u|).
        let overlap = if edge.direction.sign() > 0.0 { 1.3e-5 } else { 1e-5 };
        for x in [0.3, 0.5, 0.75, 0.95] {
            let value = Estimate { value: gain.polynomial.at(x), error: gain.polynomial.error_at(x) };
            let bent = truth * (1.0 - overlap / (x * 1e-4));
            assert!((value.value / bent - 1.0).abs() < 0.02, "{} at {x}: {value:?} for {bent}", edge.name());
        }
    }
    let friction = found.friction.unwrap();
    assert!(!friction.from_load_cell);
    assert_found("load share", friction.load_share.unwrap(), 1.0, 0.002);
    assert_found("Coulomb friction", friction.coefficient("coulomb_friction").unwrap(), 600.0, 0.01);
    assert_found("viscous damping", friction.coefficient("viscous_damping").unwrap(), VISCOUS, 0.01);
    assert_found("hose loss", friction.coefficient("hose_loss").unwrap(), 4e4, 0.01);
    assert_eq!(friction.coefficient("stribeck_friction"), None, "{}", friction.reason);
}

#[test]
fn stribeck_friction_shows_on_a_load_cell_in_slow_strokes() {
    let folder = tempfile::tempdir().unwrap();
    let hidden: &[(&str, &[f64])] = &[
        ("valve_dead_zone", &[1.2e-5, 1.2e-5]),
        ("coulomb_friction", &[600.0]),
        ("stribeck_friction", &[200.0, 0.02]),
    ];
    let plant = bench(hidden);
    let fast = record(folder.path(), &plant, "bench-trapezoids.toml", 11, true);
    let slow = record(folder.path(), &plant, "bench-slow-strokes.toml", 12, true);
    let friction = found(&[&fast, &slow]).friction.unwrap();
    assert!(friction.from_load_cell && friction.load_share.is_none());
    assert_eq!(friction.coefficient("hose_loss"), None, "{}", friction.reason);
    assert_found("Coulomb friction", friction.coefficient("coulomb_friction").unwrap(), 600.0, 0.02);
    assert_found("viscous damping", friction.coefficient("viscous_damping").unwrap(), VISCOUS, 0.01);
    let faded = friction.stribeck_speed.unwrap();
    assert_found("Stribeck force", friction.coefficient("stribeck_friction").unwrap(), 200.0, 0.05);
    assert_found("Stribeck speed", faded, 0.02, 0.03);
    for speed in [0.015_f64, 0.02, 0.03, 0.2] {
        let truth = 600.0 + VISCOUS * speed + 200.0 * (-(speed / 0.02).powi(2)).exp();
        let at = friction.at(speed).value;
        assert!((at / truth - 1.0).abs() < 0.03, "{at} for {truth} N at {speed} m/s");
    }
    // Where friction falls faster with speed than damping rises, slow strokes stick and slip; those are no steady stretches.
    let jerky = bench(&[hidden[0], hidden[1], ("stribeck_friction", &[500.0, 0.02])]);
    let jerky = record(folder.path(), &jerky, "bench-slow-strokes.toml", 13, true);
    let points = found(&[&fast, &jerky]).friction.unwrap().points;
    assert!(points.iter().all(|point| point.speed.abs() > 0.026), "{points:?}");
    // Slow strokes are what it takes: without them nothing says that the term is there.
    assert_eq!(found(&[&fast]).friction.unwrap().coefficient("stribeck_friction"), None);
}

#[test]
fn a_valve_that_bends_is_told_from_one_with_a_dead_zone() {
    let folder = tempfile::tempdir().unwrap();
    let plant = bench(&[("valve_gain_curve", &[0.4, -0.2])]);
    let recordings = campaign(folder.path(), &plant, false);
    let found = found(&recordings.iter().collect::<Vec<_>>());
    for (edge, zone) in found.dead_zones {
        let zone = zone.unwrap();
        assert!(zone.dead_zone.value.abs() < 3e-7, "{}: {:?}", edge.name(), zone.dead_zone);
        assert!(zone.hysteresis.value.abs() < 3e-7, "{}: {:?}", edge.name(), zone.hysteresis);
    }
    for (edge, gain) in found.gains {
        let curve = gain.unwrap().polynomial;
        assert!((1..=3).contains(&curve.degree()), "{}: {}", edge.name(), curve.reason);
        for x in [0.3, 0.6, 0.95] {
            let truth = GAIN * (1.0 + 0.4 * x - 0.2 * x * x);
            let off = curve.at(x) / truth - 1.0;
            assert!(off.abs() < 0.01, "{} at {x}: {off}", edge.name());
        }
    }
}

#[test]
fn recordings_that_do_not_suit_are_refused_with_the_number_that_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let plant = bench(&HIDDEN);
    let sine = record(folder.path(), &plant, "bench-sine-0.50.toml", 21, false);
    let only_sine = found(&[&sine]);
    for (_, gain) in &only_sine.gains {
        let Err(Refusal::TooFewSteadyStretches { found: 0, needed: 5, longest, .. }) = gain else { panic!("{gain:?}") };
        assert!(*longest < 0.25, "{longest}");
    }
    let Err(Refusal::TooFewHolds { found: holds, needed: 3, longest, .. }) = &only_sine.leakage else {
        panic!("{:?}", only_sine.leakage)
    };
    assert!(*holds < 3 && *longest < 1.2, "{holds}, {longest}");
    assert!(matches!(only_sine.friction, Err(Refusal::TooFewSpeeds { found: 0, .. })), "{:?}", only_sine.friction);
    // A sine does suit dead zone and hysteresis.
    assert!(only_sine.dead_zones.iter().all(|(_, zone)| zone.is_ok()));

    // One stroke each way: two plateaus are no curve, and one run through the edge is no mean.
    let stroke = record(folder.path(), &plant, "bench-trapezoids.toml", 22, false).part(0.0, 6.5);
    let one_stroke = found(&[&stroke]);
    for (_, gain) in &one_stroke.gains {
        let Err(refusal @ Refusal::TooFewSteadyStretches { openings: 1, longest, .. }) = gain else {
            panic!("{gain:?}")
        };
        assert!(*longest > 1.0 && refusal.to_string().contains("5 at 4 are needed"), "{refusal}");
    }
    for (_, zone) in &one_stroke.dead_zones {
        let Err(Refusal::TooFewSweeps { found_opening: 1, needed: 2, .. }) = zone else { panic!("{zone:?}") };
    }

    let mut blind = sine.clone();
    blind.cylinders[0].rod_pressure.fill(f64::NAN);
    let Err(refusal) = found(&[&blind]).friction else { panic!("a pressure is missing") };
    assert!(refusal.to_string().contains("does not measure load.rod_pressure"), "{refusal}");

    // Friction from pressures alone needs both directions.
    let trapezoids = record(folder.path(), &plant, "bench-trapezoids.toml", 23, false);
    let mut one_way = trapezoids.clone();
    for index in 0..one_way.len() {
        if one_way.cylinders[0].orifice_area[index] < -1e-6 {
            one_way.cylinders[0].displacement[index] = f64::NAN;
        }
    }
    let Err(Refusal::TooFewSpeeds { retracting: 0, extending, both, .. }) = found(&[&one_way]).friction else {
        panic!("only strokes outwards are left")
    };
    assert!(extending >= 16 && both.contains("no load cell"), "{extending}{both}");
}

#[test]
fn a_closed_valve_that_hardly_leaks_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let closed = record(folder.path(), &bench(&[("coulomb_friction", &[600.0])]), "bench-closed-valve.toml", 31, false);
    match found(&[&closed]).leakage {
        Err(Refusal::TransientsTooSmall { holds, longest, relative_error, .. }) => {
            assert!(holds >= 8 && longest > 5.0 && relative_error > 50.0);
        }
        other => panic!("{other:?}"),
    }
}

/// A real one: a testing machine that moves a seal at one speed says nothing of friction against speed.
#[test]
fn a_measured_seal_at_one_speed_is_refused() {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../bags/samples/seal-friction");
    let words = |name: &str| samples.join(name).to_str().unwrap().to_string();
    let (table, map, rig) = (words("O-ring_3bar.csv"), words("map.toml"), words("rig.toml"));
    let output = excavator(Path::new("."), &["characterise", &table, "--map", &map, "--model", &rig, "--json", "-"]);
    let friction = json(&output)["cylinders"][0]["friction"]["refused"].as_str().unwrap().to_string();
    assert!(friction.contains("3 speeds and 2 times are needed"), "{friction}");
}

#[test]
fn the_verb_prints_writes_and_refuses() {
    let folder = tempfile::tempdir().unwrap();
    let recording = record(folder.path(), &bench(&HIDDEN), "bench-trapezoids.toml", 41, false);
    let bag = folder.path().join("measured");
    write_recording(&bag, &recording, &Topics::default(), &WriteOptions::default()).unwrap();
    let words = ["characterise", "measured", "--model", "servo-bench", "--report", "page.html", "--json", "-"];
    let found = json(&excavator(folder.path(), &words));
    let load = &found["cylinders"][0];
    assert_eq!(load["name"], "load");
    let coulomb = &load["friction"]["terms"][0];
    assert_eq!(coulomb["effect"], "coulomb_friction");
    assert!((coulomb["value"].as_f64().unwrap() / 600.0 - 1.0).abs() < 0.02, "{coulomb}");
    assert!(load["gains"]["cap_negative"]["from_edge"]["coefficients"][0].as_f64().unwrap() > 5e-3);
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    for text in ["Gains of the metering edges", "Leakage of the closed valve", "Friction against speed", "</html>"] {
        assert!(page.contains(text), "{text}");
    }
    let table = excavator(folder.path(), &["characterise", "measured@0..6.5", "--model", "servo-bench"]);
    let table = String::from_utf8(table.stdout).unwrap();
    assert!(
        table.contains("no gain pump to cap side: 1 steady stretches") || table.contains("steady stretches at 1"),
        "{table}"
    );
    let none = excavator(folder.path(), &["characterise", "nowhere", "--model", "servo-bench"]);
    assert_one_clear_line(&none, &["nowhere"]);
}
