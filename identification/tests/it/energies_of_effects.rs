//! Energies of effects against the integral of their powers along the recorded path.

use excavator_identification::energy::{EnergySettings, analyse};
use excavator_identification::results::Energy;
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::energy::{Ledger, ledger};
use excavator_model::equations::{Inputs, KnownCylinder, System};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};

/// The paper's machine and sine, without noise.
fn recorded(model: &Model, frequency: f64, start: f64) -> Recording {
    let time: Vec<f64> = (0..6000).map(|index| f64::from(index) * 2e-3).collect();
    let mut recording = Recording::unmeasured("sine", time, &["arm"]);
    recording.tank_pressure.fill(0.0);
    recording.pump_flow.fill(3.8e-4);
    let sine = |t: &f64| 1e-4 * (std::f64::consts::TAU * frequency * t).sin();
    recording.cylinders[0].orifice_area = recording.time.iter().map(sine).collect();
    simulate_from_rest(model, &recording, &[start], Tolerances::default()).unwrap()
}

/// Ledger of each sample, with nothing smoothed.
fn ledgers(model: &Model, recording: &Recording) -> Vec<Ledger> {
    let system = System::new(model);
    let (mut state, mut inputs) = (vec![0.0; system.layout().len], Inputs::zero(1));
    let (arm, parameters) = (&recording.cylinders[0], model.parameter_values());
    let of = |sample: usize| {
        inputs.time = recording.time[sample];
        inputs.pump_flow = recording.pump_flow[sample];
        inputs.tank_pressure = recording.tank_pressure[sample];
        inputs.orifice_area[0] = arm.orifice_area[sample];
        let known = |_| KnownCylinder {
            joint: model.machine.cylinders[0].linkage.joint(arm.displacement[sample]),
            velocity: arm.velocity[sample],
            pressures: [arm.cap_pressure[sample], arm.rod_pressure[sample]],
        };
        system.set_measured(known, recording.pump_pressure[sample], &mut state);
        ledger(&system, &parameters, &state, &inputs)
    };
    (0..recording.len()).map(of).collect()
}

/// With a chamber that boils, at both frequencies of the paper, from mid-stroke and nearly extended.
#[test]
fn each_is_the_integral_of_its_power() {
    /// Largest difference, as a share of the energy.
    const SHARE: f64 = 1e-3;
    /// The same as a share of the pump's energy, for effects that hardly act.
    const SHARE_OF_ALL: f64 = 2e-6;
    let model = built_in("zx30u-arm").unwrap();
    for (frequency, start) in [(0.5, 0.0), (1.0, 0.0), (0.5, 0.27), (1.0, 0.27)] {
        let recording = recorded(&model, frequency, start);
        let analysis = analyse(&model, &recording, EnergySettings::default()).unwrap();
        let books = ledgers(&model, &recording);
        let traced = &analysis.traces.cylinders[0].time;
        let (first, last) = (traced[0], traced[traced.len() - 1]);
        let integral = |power: &dyn Fn(&Ledger) -> f64| -> f64 {
            (1..recording.len())
                .filter(|&k| recording.time[k - 1] > first - 1e-9 && recording.time[k] < last + 1e-9)
                .map(|k| 0.5 * (recording.time[k] - recording.time[k - 1]) * (power(&books[k]) + power(&books[k - 1])))
                .sum()
        };
        let pump = integral(&|book| book.pump_power);
        assert!((analysis.totals.pump / pump - 1.0).abs() < SHARE, "pump: {} is not {pump}", analysis.totals.pump);
        let mut boiled = 0.0;
        for (number, effect) in analysis.totals.effects.iter().enumerate() {
            let into_cylinders = integral(&|book| book.effects[number].into_cylinders());
            let into_pump_line = integral(&|book| book.effects[number].pump_line);
            for (found, wanted) in [(effect.into_cylinders, into_cylinders), (effect.into_pump_line, into_pump_line)] {
                println!(
                    "{frequency} Hz from {start} m: {:20} {found:10.4} J, integral {wanted:10.4} J",
                    effect.effect
                );
                let limit = SHARE * wanted.abs() + SHARE_OF_ALL * pump;
                assert!((found - wanted).abs() < limit, "{}: {found} is not {wanted}", effect.effect);
            }
            if effect.effect == "cavitation" {
                boiled = into_cylinders;
            }
        }
        assert!(boiled < -0.1, "nothing boils: {boiled} J");
    }
}

/// What the pump gives while the valve is open towards one side, and towards the other, is all that it gives.
#[test]
fn powers_by_the_sign_of_the_opening_add_up() {
    let model = built_in("zx30u-arm").unwrap();
    let analysis = analyse(&model, &recorded(&model, 0.5, 0.27), EnergySettings::default()).unwrap();
    let (whole, [both]) = (&analysis.totals, &analysis.by_opening[..]) else { panic!("one cylinder") };
    let [positive, negative] = [&both.positive, &both.negative];
    // The opening is exactly zero in the first sample alone.
    let duration = positive.duration + negative.duration;
    assert!((duration - whole.duration).abs() < 0.01, "{duration} s of {}", whole.duration);
    let supplied = positive.cylinders[0].supplied + negative.cylinders[0].supplied;
    let wanted = whole.cylinders[0].supplied;
    assert!((supplied / wanted - 1.0).abs() < 1e-3, "{supplied} J of {wanted}");
    // [A] Section 5.2: the pump gives little for u > 0; the sinking arm gives back more than that for u < 0.
    let [up, down] = [positive, negative].map(|part| part.cylinders[0].supplied / part.duration);
    println!("mean supply {up:.1} W for u > 0, {down:.1} W for u < 0");
    assert!(up.abs() < 0.2 * down.abs() && down < -100.0, "{up} W, {down} W");
}

/// The thinned traces of the result keep the peaks, and every column has one value for each time.
#[test]
fn thinned_traces_keep_peaks() {
    let model = built_in("zx30u-arm").unwrap();
    let analysis = analyse(&model, &recorded(&model, 1.0, 0.27), EnergySettings::default()).unwrap();
    let result = Energy::of(&model, &analysis);
    let (trace, whole) = (&result.traces["arm"], &analysis.traces.cylinders[0]);
    let count = trace.time.len();
    assert!((300..600).contains(&count), "{count} samples");
    assert_eq!([trace.supply.len(), trace.hamiltonian.len(), trace.numerical_dissipation.len()], [count; 3]);
    assert!(trace.terms.values().all(|term| [term.analytical.len(), term.numerical.len()] == [count; 2]));
    let peak = |values: &mut dyn Iterator<Item = f64>| values.filter(|value| value.is_finite()).fold(0.0, f64::max);
    for (thinned, all) in [
        (&trace.supply, &whole.supply.value),
        (&trace.experimental_rate, &whole.experimental.value),
        (&trace.dissipation, &whole.dissipation.value),
    ] {
        let kept = peak(&mut thinned.iter().flatten().copied());
        assert_eq!(kept, peak(&mut all.iter().copied()));
    }
    assert_eq!(result.phase_criterion.unwrap().met, Some(true));
}
