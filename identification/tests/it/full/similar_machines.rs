//! The same machine larger, smaller, or with its openings in another unit gets the same verdict, and coefficients in proportion.

use crate::common::scaled::{Scale, scaled, size_of};
use crate::common::{add_noise, off_the_data_sheet, with};
use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::{DiagnosisSettings, diagnose};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::Site;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The machine steered by two sines, as good instruments of its size see it.
fn steered(machine: &Model, scale: Scale, tempo: f64, duration: f64, seed: u64) -> Recording {
    let (length, size) = (scale.0, size_of(scale));
    let time: Vec<f64> = (0..(duration * 500.0) as usize).map(|index| length * index as f64 / 500.0).collect();
    let mut recording = Recording::unmeasured("steered", time, &["arm"]);
    recording.tank_pressure.fill(6e5);
    recording.pump_flow.fill(3.8e-4 * length * length);
    let area = |t: f64| size.opening * (6e-5 * (tempo * t / length).sin() + 4e-5 * (2.7 * tempo * t / length).sin());
    recording.cylinders[0].orifice_area = recording.time.iter().map(|&t| area(t)).collect();
    let rest = [0.05 * length];
    let mut seen = simulate_from_rest(machine, &recording, &rest, Tolerances::default().scaled(0.05)).unwrap();
    let random = &mut ChaCha8Rng::seed_from_u64(seed);
    let signals = &mut seen.cylinders[0];
    [&mut signals.velocity, &mut signals.joint_angle, &mut signals.rod_force]
        .into_iter()
        .for_each(|s| s.fill(f64::NAN));
    add_noise(random, &mut signals.displacement, 5e-5 * length);
    add_noise(random, &mut signals.cap_pressure, 2e3);
    add_noise(random, &mut signals.rod_pressure, 2e3);
    add_noise(random, &mut signals.orifice_area, 2e-7 * size.opening);
    add_noise(random, &mut seen.pump_pressure, 2e3);
    seen
}

/// Verdict and coefficients of a machine with a hidden effect, each with its 95 % interval, in units of the machine of usual size.
fn judged(effect: Option<(&str, &[f64])>, scale: Scale) -> (Kind, Vec<String>, Vec<[f64; 2]>) {
    let nominal = built_in("zx30u-arm").unwrap();
    let machine = effect.map_or(nominal.clone(), |(name, values)| with(&nominal, name, Site::Cylinder(0), values));
    let (machine, given) = (scaled(&machine, scale), scaled(&off_the_data_sheet("zx30u-arm", 0.1), scale));
    let (identification, validation) = (steered(&machine, scale, 2.9, 16.0, 1), steered(&machine, scale, 3.4, 10.0, 2));
    let settings = DiagnosisSettings::default();
    let found = diagnose(&given, &[&identification], &[&validation], &settings, &|_, _| {}).unwrap();
    let selected = found.selected();
    let names = selected.iter().map(|one| one.name().to_string()).collect();
    let size = size_of(scale);
    let fitted = selected.iter().flat_map(|one| {
        let effects = &one.trial.fit.model.effects;
        effects.iter().filter(|effect| effect.is(one.name(), one.addition.site)).flat_map(|effect| &effect.parameters)
    });
    let values = fitted
        .map(|parameter| {
            [parameter.value, parameter.margin_95.unwrap_or(0.0)].map(|one| one / size.factor(parameter.card.growth))
        })
        .collect();
    (found.verdict.kind, names, values)
}

fn are_judged_alike(effects: &[Option<(&str, &[f64])>], scales: &[Scale]) {
    let mut unlike = Vec::new();
    for &effect in effects {
        let usual = judged(effect, (1.0, 1.0));
        let wanted = effect.map_or(Kind::Adequate, |_| Kind::MissingEffect);
        println!("{effect:?}: {usual:?}");
        assert_eq!(usual.0, wanted, "{effect:?}: {usual:?}");
        for &scale in scales {
            let other = judged(effect, scale);
            println!("{effect:?} {scale:?}: {other:?}");
            // Within 2 %, or as closely as the recordings determine it.
            let is_near = |([one, margin], [two, other]): (&[f64; 2], &[f64; 2])| {
                (two - one).abs() < (0.02 * one.abs()).max(margin.hypot(*other))
            };
            let in_proportion = usual.2.iter().zip(&other.2).all(is_near);
            if (&usual.0, &usual.1) != (&other.0, &other.1) || !in_proportion {
                unlike.push(format!("{effect:?} at {scale:?}: {other:?}, and {usual:?} at the usual size"));
            }
        }
    }
    assert!(unlike.is_empty(), "{}", unlike.join("\n"));
}

#[test]
fn a_small_and_a_large_machine_are_judged_alike() {
    are_judged_alike(&[Some(("valve_dead_zone", &[6e-6, 8e-6]))], &[(0.1, 1.0), (3.0, 1e6)]);
}

#[test]
#[ignore = "five minutes; tests/run --long"]
fn so_are_machines_of_every_size() {
    let effects: &[Option<(&str, &[f64])>] = &[
        None,
        Some(("stribeck_friction", &[600.0, 0.012])),
        Some(("pressure_dependent_friction", &[2e-4])),
        Some(("valve_lag", &[0.04, 0.0])),
        Some(("entrained_air", &[0.02])),
        Some(("valve_hysteresis", &[1e-5, 1.0])),
    ];
    are_judged_alike(effects, &[(0.1, 1.0), (0.2, 1.0), (3.0, 1.0), (10.0, 1.0), (1.0, 1e6)]);
}
