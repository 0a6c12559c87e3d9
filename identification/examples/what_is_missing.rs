//! What a model is missing: `cargo run --release -p excavator-identification --example what_is_missing`.
//!
//! Records an arm whose valve has a dead zone, refines a model that has none and whose other numbers are off by up to 10 %, and prints
//! what was missing. It takes some seconds.

use std::error::Error;

use excavator_identification::prelude::*;
use excavator_model::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

fn main() -> Result<(), Box<dyn Error>> {
    let nominal = built_in("zx30u-arm")?;
    let machine = with_dead_zone(&nominal, [6e-6, 8e-6])?;
    let given = off_by_a_tenth(&nominal);
    // Parameters are fitted to one recording, and evidence comes from another.
    let (fitted, judging) = (recorded(&machine, 2.9, 16.0, 1)?, recorded(&machine, 3.4, 10.0, 2)?);

    let settings = DiagnosisSettings::default();
    let progress = |what: &str, share: f64| eprintln!("{:3.0} % {what}", 100.0 * share);
    let when = "2025-01-01T00:00:00Z";
    let refined = refine(&given, &[&fitted], &[&judging], &Additions::Auto, &settings, when, &progress)?;

    match refined.verdict() {
        Kind::Adequate => println!("nothing that matters is missing"),
        Kind::MissingEffect => println!("an effect is missing:"),
        Kind::Unexplained => println!("something is missing that no effect of the catalogue explains"),
    }
    for candidate in refined.diagnosis().into_iter().flat_map(Diagnosis::selected) {
        println!("  {} at the {}", candidate.name(), candidate.place());
        for parameter in candidate.effect().into_iter().flat_map(|effect| &effect.parameters) {
            let (factor, unit) = match &*parameter.card.unit {
                "m2" => (1e6, "mm²"),
                unit => (1.0, unit),
            };
            let [value, margin] = [parameter.value, parameter.margin_95.unwrap_or(f64::NAN)].map(|one| factor * one);
            println!("    {}: {value:.2} ± {margin:.2} {unit}", parameter.card.meaning);
        }
    }

    println!("fit to the recording that was not fitted, given and refined");
    let (before, after) = (compare(&given, &judging)?, compare(&refined.model, &judging)?);
    for (before, after) in before.signals.iter().zip(&after.signals) {
        println!("  {:<20} {:6.1} % {:6.1} %", before.name, before.error.fit_percent(), after.error.fit_percent());
    }
    Ok(())
}

/// The model with a dead zone towards either side of the piston, m².
fn with_dead_zone(model: &Model, areas: [f64; 2]) -> Result<Model, Box<dyn Error>> {
    let mut model = model.with_effect(&model.catalogue.find("valve_dead_zone")?, Site::Cylinder(0))?;
    for effect in model.effects.iter_mut().filter(|effect| effect.name() == "valve_dead_zone") {
        effect.parameters.iter_mut().zip(areas).for_each(|(parameter, area)| parameter.value = area);
    }
    Ok(model)
}

/// The model with numbers that are up to 10 % off, as those of a data sheet are.
fn off_by_a_tenth(model: &Model) -> Model {
    let mut model = model.clone();
    for (number, parameter) in model.parameters_mut().filter(|parameter| !parameter.known).enumerate() {
        parameter.value *= 1.0 + 0.1 * (1.7 * number as f64 + 0.4).sin();
    }
    model
}

/// The arm steered by two sines, whose frequencies grow with `tempo` (rad/s), for `duration` s, as good instruments see it at 500 Hz:
/// displacement, pressures and the opening of the valve, with noise.
fn recorded(machine: &Model, tempo: f64, duration: f64, seed: u64) -> Result<Recording, Box<dyn Error>> {
    let time: Vec<f64> = (0..(500.0 * duration) as usize).map(|sample| sample as f64 / 500.0).collect();
    let mut command = Recording::unmeasured("steered", time, &["arm"]);
    command.tank_pressure.fill(6e5);
    command.pump_flow.fill(3.8e-4);
    let area = |t: &f64| 6e-5 * (tempo * t).sin() + 4e-5 * (2.7 * tempo * t).sin();
    command.cylinders[0].orifice_area = command.time.iter().map(area).collect();
    let mut seen = simulate_from_rest(machine, &command, &[0.05], Tolerances::default().scaled(0.05))?;

    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let arm = &mut seen.cylinders[0];
    arm.velocity.fill(f64::NAN);
    arm.joint_angle.fill(f64::NAN);
    add_noise(&mut random, &mut arm.displacement, 5e-5);
    add_noise(&mut random, &mut arm.cap_pressure, 2e3);
    add_noise(&mut random, &mut arm.rod_pressure, 2e3);
    add_noise(&mut random, &mut arm.orifice_area, 2e-7);
    add_noise(&mut random, &mut seen.pump_pressure, 2e3);
    Ok(seen)
}

/// White noise of a standard deviation, in the signal's unit.
fn add_noise(random: &mut ChaCha8Rng, signal: &mut [f64], level: f64) {
    for value in signal {
        let normal: f64 = StandardNormal.sample(random);
        *value += level * normal;
    }
}
