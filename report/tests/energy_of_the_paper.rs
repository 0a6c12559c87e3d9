//! Figures 10, 11 and 12 of \[A\] on simulated data of the paper's machine, with what the paper observes in them.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

use excavator_identification::energy::{CylinderTraces, EnergyAnalysis, EnergySettings, analyse};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use excavator_report::energy_page;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// The machine of the paper moved by `1e-4 sin(2 pi f t)` m², measured at 500 Hz by sensors with noise. It starts nearly
/// extended, from where it drifts in as in the paper: pressures, and with them leakage, are high there. About mid-stroke
/// of this machine external leakage is no greater than Coulomb friction.
fn measured(model: &Model, frequency: f64) -> Recording {
    let time: Vec<f64> = (0..6000).map(|index| f64::from(index) * 2e-3).collect();
    let mut recording = Recording::unmeasured("simulated experiment", time, &["arm"]);
    recording.tank_pressure.fill(0.0);
    recording.pump_flow.fill(3.8e-4);
    let sine = |t: &f64| 1e-4 * (std::f64::consts::TAU * frequency * t).sin();
    recording.cylinders[0].orifice_area = recording.time.iter().map(sine).collect();
    let mut recording = simulate_from_rest(model, &recording, &[0.27], Tolerances::default()).unwrap();
    recording.cylinders[0].velocity.fill(f64::NAN);
    recording.cylinders[0].joint_angle.fill(f64::NAN);
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    let mut add = |signal: &mut Vec<f64>, level: f64| {
        for value in signal {
            let normal: f64 = StandardNormal.sample(&mut random);
            *value += level * normal;
        }
    };
    add(&mut recording.cylinders[0].displacement, 5e-5);
    add(&mut recording.cylinders[0].cap_pressure, 2e3);
    add(&mut recording.cylinders[0].rod_pressure, 2e3);
    add(&mut recording.cylinders[0].orifice_area, 2e-7);
    add(&mut recording.pump_pressure, 2e3);
    recording
}

fn analysed(frequency: f64) -> (Model, EnergyAnalysis) {
    let model = built_in("zx30u-arm").unwrap();
    let analysis = analyse(&model, &measured(&model, frequency), EnergySettings::default()).unwrap();
    (model, analysis)
}

/// Mean of the finite values under a condition on the entry.
fn mean(values: &[f64], of: impl Fn(usize) -> bool) -> f64 {
    let (count, sum) = values
        .iter()
        .enumerate()
        .filter(|(entry, value)| value.is_finite() && of(*entry))
        .fold((0.0, 0.0), |(count, sum), (_, value)| (count + 1.0, sum + value));
    sum / count
}

fn term<'a>(trace: &'a CylinderTraces, effect: &str) -> &'a [f64] {
    &trace.terms.iter().find(|term| term.effect == effect).unwrap().analytical
}

/// Largest value by size.
fn peak(values: &[f64]) -> f64 {
    values.iter().filter(|value| value.is_finite()).fold(0.0, |peak: f64, value| peak.max(value.abs()))
}

#[test]
fn the_three_rates_agree_in_phase_within_their_error_bars() {
    for frequency in [0.5, 1.0] {
        let (_, analysis) = analysed(frequency);
        let trace = &analysis.traces.cylinders[0];
        let phase = trace.phase.unwrap();
        println!("{frequency} Hz: {phase:?}");
        assert!((phase.frequency - frequency).abs() < 0.05);
        // [A] asks for less than 90 degrees; with the same model on both sides far less is left.
        assert!(phase.largest().unwrap() < 5.0);
        let squares: Vec<f64> = trace.analytical.value.iter().map(|rate| rate * rate).collect();
        let size = mean(&squares, |_| true).sqrt();
        let inside: Vec<f64> = (0..trace.time.len())
            .map(|k| {
                let error = trace.experimental.error[k].hypot(trace.analytical.error[k]);
                let difference = (trace.experimental.value[k] - trace.analytical.value[k]).abs();
                f64::from(u8::from(difference <= 2.5 * error + 0.02 * size))
            })
            .collect();
        let share = mean(&inside, |_| true);
        println!("  size {size:.0} W, {share:.3} of the differences within the error bars");
        assert!(share > 0.9);
    }
}

#[test]
fn a_symmetric_input_gives_an_asymmetric_rate() {
    for frequency in [0.5, 1.0] {
        let (_, analysis) = analysed(frequency);
        let trace = &analysis.traces.cylinders[0];
        let opening = |positive: bool| mean(&trace.opening, |k| (trace.opening[k] > 0.0) == positive);
        assert!((opening(true) + opening(false)).abs() < 0.05 * opening(true), "the input is not symmetric");
        let rates = trace.analytical.value.iter().filter(|rate| rate.is_finite());
        let (up, down) = rates.fold((0.0_f64, 0.0_f64), |(up, down), &rate| (up.max(rate), down.min(rate)));
        let asymmetry = (up + down).abs() / (up - down);
        println!("{frequency} Hz: dH/dt from {down:.0} to {up:.0} W, asymmetry {asymmetry:.2}");
        assert!(asymmetry > 0.1);
    }
}

#[test]
fn coulomb_friction_is_much_smaller_and_leakage_is_there_at_supply_peaks_only() {
    for frequency in [0.5, 1.0] {
        let (_, analysis) = analysed(frequency);
        let trace = &analysis.traces.cylinders[0];
        let coulomb = peak(term(trace, "coulomb_friction"));
        println!("{frequency} Hz: Coulomb friction {coulomb:.1} W at most");
        for other in ["viscous_damping", "internal_leakage", "external_leakage"] {
            println!("  {other}: {:.1} W at most", peak(term(trace, other)));
            assert!(peak(term(trace, other)) > 2.0 * coulomb, "{other}");
        }
        let supply_peak = peak(&trace.supply.value);
        for leakage in ["internal_leakage", "external_leakage"] {
            let powers = term(trace, leakage);
            let quiet = mean(powers, |k| trace.supply.value[k].abs() < 0.1 * supply_peak).abs();
            let busy = mean(powers, |k| trace.supply.value[k].abs() > 0.5 * supply_peak).abs();
            println!("  {leakage}: {quiet:.2} W away from supply peaks, {busy:.2} W at them");
            assert!(quiet < 0.1 * peak(powers), "{leakage}: {quiet}");
            assert!(quiet < 0.2 * busy, "{leakage}: {quiet} {busy}");
        }
    }
}

#[test]
fn the_page_has_the_figures_of_the_paper() {
    for frequency in [0.5, 1.0] {
        let (model, analysis) = analysed(frequency);
        assert!(analysis.is_explained(), "{:#?}", analysis.places);
        let page = energy_page(&model, &analysis);
        for text in [
            "experimental",
            "numerical",
            "analytical supply",
            "numerical dissipation",
            "internal leakage",
            "coulomb friction",
            "class=\"verdict adequate\"",
        ] {
            assert!(page.contains(text), "{text}");
        }
        // For people who want to see them.
        if let Some(folder) = std::env::var_os("EXCAVATOR_PAGES") {
            let file = std::path::Path::new(&folder).join(format!("energy-{frequency}-hz.html"));
            std::fs::write(file, page).unwrap();
        }
    }
}
