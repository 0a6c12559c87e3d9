//! Where the energy of a swing goes: `cargo run -p excavator-model --example swing`.
//!
//! Gives the arm of an excavator a seal that sticks, swings it to and fro, and adds up what the pump gave, what each effect took, and
//! what is stored at the end.

use std::error::Error;

use excavator_model::prelude::*;
use excavator_model::{addition_name, site_name};

/// Time between two samples, s.
const INTERVAL: f64 = 1e-3;

/// Samples of the swing.
const SAMPLES: i32 = 4000;

/// Where the piston starts, m from mid-stroke.
const START: f64 = 0.1;

fn main() -> Result<(), Box<dyn Error>> {
    let plain = built_in("zx30u-arm")?;
    let seal = plain.catalogue.find("stribeck_friction")?;
    let model = plain.with_effect(&seal, Site::Cylinder(0))?;
    let command = command();

    let swing = simulate_from_rest(&model, &command, &[START], Tolerances::default())?;
    let arm = swing.cylinder("arm")?;
    let [shortest, longest] = range(&arm.displacement).map(|displacement| 1e3 * displacement);
    let [_, highest] = range(&arm.cap_pressure).map(|pressure| 1e-6 * pressure);
    println!("{}", model.machine.description);
    println!("piston from {shortest:.0} to {longest:.0} mm, cap side up to {highest:.1} MPa");

    let books = books(&model, &command)?;
    let (Some(first), Some(last)) = (books.first(), books.last()) else { return Ok(()) };
    let line = |what: &str, energy: f64| println!("  {what:<30} {energy:8.1} J");
    println!("energy");
    let given = energy(&books, |book| book.pump_power);
    line("given by the pump", given);
    let mut taken = 0.0;
    for (number, effect) in model.effects.iter().enumerate().filter(|(number, _)| first.effects[*number].has_power) {
        let own = 0.0 - energy(&books, |book| book.effects[number].total());
        line(&addition_name(effect.name(), site_name(&model.machine, effect.site)), own);
        taken += own;
    }
    let stored = last.stored() - first.stored();
    line("stored in links and oil", stored);
    line("not accounted for", given - taken - stored);
    Ok(())
}

/// Two periods of a sine of 90 mm² at 0.5 Hz.
fn command() -> Recording {
    let segments = vec![Segment::Sine { duration: f64::from(SAMPLES) * INTERVAL, amplitude: 9e-5, frequency: 0.5 }];
    let time = (0..=SAMPLES).map(|sample| f64::from(sample) * INTERVAL).collect();
    let mut recording = Recording::unmeasured("swing", time, &["arm"]);
    Profile::command(&[Profile { cylinder: "arm".into(), segments }], &mut recording);
    recording
}

/// The energy balance at each sample of a simulation.
fn books(model: &Model, command: &Recording) -> Result<Vec<Ledger>, Box<dyn Error>> {
    let (system, parameters) = (System::new(model), model.parameter_values());
    let signals = InputSignals::from_recording(model, command)?;
    let mut inputs = signals.at_start();
    let mut state = rest_state(&system, &[START], &inputs);
    let mut integrator = Integrator::new(&system, &parameters, &[], Tolerances::default());
    let mut accountant = Accountant::new(&system);
    let mut books = Vec::with_capacity(signals.len());
    integrator.follow(&signals, &mut state, |sample, state| {
        signals.between(sample, 0.0, &mut inputs);
        books.push(accountant.ledger(&parameters, state, &inputs));
    })?;
    Ok(books)
}

/// Energy of a power over all samples, J: trapezoids from one to the next.
fn energy(books: &[Ledger], power: impl Fn(&Ledger) -> f64) -> f64 {
    books.windows(2).map(|pair| 0.5 * INTERVAL * (power(&pair[0]) + power(&pair[1]))).sum()
}

/// The least and the largest value.
fn range(values: &[f64]) -> [f64; 2] {
    [values.iter().copied().fold(f64::INFINITY, f64::min), values.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
}
