//! A rod that a testing machine moves: the force that this takes is the output.

use std::f64::consts::TAU;

use excavator_model::document::{parse, to_text};
use excavator_model::effects::Catalogue;
use excavator_model::recording::Recording;
use excavator_model::simulation::simulate;

const RIG: &str = include_str!("../../../bags/samples/seal-friction/rig.toml");

const FURTHER: &str = r#"
[[effects]]
effect = "viscous_damping"
at = "load"
[effects.parameters]
viscous_damping = { value = 40.0, unit = "N s/m", source = "test" }

[[effects]]
effect = "pressure_dependent_friction"
at = "load"
[effects.parameters]
pressure_friction = { value = 8e-6, unit = "m2", source = "test" }
"#;

/// The rod swings by 15 mm at 0.2 Hz while the pressure rises from 1 bar to 3 bar; 100 Hz.
fn swing() -> Recording {
    let time: Vec<f64> = (0..1000).map(|k| 0.01 * f64::from(k)).collect();
    let mut recording = Recording::unmeasured("swing", time.clone(), &["load"]);
    let load = &mut recording.cylinders[0];
    load.displacement = time.iter().map(|t| 0.015 * (TAU * 0.2 * t).sin()).collect();
    load.cap_pressure = time.iter().map(|t| 1e5 + 2e4 * t).collect();
    load.rod_force = vec![0.0; time.len()];
    recording
}

#[test]
fn the_force_is_what_inertia_friction_and_pressure_take() {
    let model = parse("rig", &format!("{RIG}{FURTHER}"), &Catalogue::built_in()).unwrap();
    let recording = swing();
    let simulated = simulate(&model, &recording).unwrap();
    for (index, &t) in recording.time.iter().enumerate() {
        let speed = 0.015 * TAU * 0.2 * (TAU * 0.2 * t).cos();
        let acceleration = -0.015 * (TAU * 0.2).powi(2) * (TAU * 0.2 * t).sin();
        // The first samples hold the transient of a start without a measured force; at reversals the parabolas bend.
        if !(0.1..=9.9).contains(&t) || speed.abs() < 5e-3 {
            continue;
        }
        let pressure = 1e5 + 2e4 * t;
        let friction = (5.0 + 8e-6 * pressure) * (speed / 1e-3).tanh() + 40.0 * speed;
        let expected = 0.3 * acceleration + friction - 4.909e-4 * pressure;
        let found = simulated.cylinders[0].rod_force[index];
        // The force follows within 2 ms, in which the pressure adds 0.02 N.
        assert!((found - expected).abs() < 0.025, "{t} s: {found} N, expected {expected} N");
        assert!((simulated.cylinders[0].displacement[index] - recording.cylinders[0].displacement[index]).abs() < 1e-5);
    }
}

#[test]
fn a_rig_survives_the_round_trip_and_takes_no_chambers() {
    let model = parse("rig", RIG, &Catalogue::built_in()).unwrap();
    assert_eq!(parse("again", &to_text(&model).unwrap(), &Catalogue::built_in()).unwrap().machine, model.machine);
    let chambers = "[machine.cylinders.chambers]\ncap_area = { value = 1e-3, unit = \"m2\" }\nrod_area = { value = 1e-3, \
                    unit = \"m2\" }\ncap_dead_volume = { value = 1e-4, unit = \"m3\" }\nrod_dead_volume = { value = 1e-4, \
                    unit = \"m3\" }\nmaximum_orifice_area = { value = 1e-4, unit = \"m2\" }\n\n[[effects]]";
    let both = RIG
        .replacen("[[effects]]", chambers, 1)
        .replace("kind = \"none\"", "kind = \"pressure_source\"\npressure = { value = 1e6, unit = \"Pa\" }\ntank_pressure = { value = 0.0, unit = \"Pa\" }");
    let refused = parse("both", &both, &Catalogue::built_in()).unwrap_err().to_string();
    assert!(refused.contains("imposed_motion"), "{refused}");
}

#[test]
fn without_a_force_or_a_displacement_there_is_a_clear_refusal() {
    let model = parse("rig", RIG, &Catalogue::built_in()).unwrap();
    for (signal, hide) in [("load.rod_force", true), ("load.displacement", false)] {
        let mut recording = swing();
        let load = &mut recording.cylinders[0];
        let hidden = if hide { &mut load.rod_force } else { &mut load.displacement };
        hidden.fill(f64::NAN);
        assert!(simulate(&model, &recording).unwrap_err().to_string().contains(signal));
    }
}
