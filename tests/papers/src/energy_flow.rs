//! \[A\] Section 5: energy of the paper's machine at both frequencies.

use excavator_identification::energy::{CylinderTraces, EnergyAnalysis, EnergySettings, analyse};
use excavator_identification::results::{ByOpening, MeanPowers};

use crate::experiment::{Sine, figure, nominal, read};

const PRESSURE_NOISE: f64 = 2e3;
const SEED: u64 = 7;

/// Frequency (Hz), where it starts (m), and the name of that place.
const CASES: [(f64, f64, &str); 4] =
    [(0.5, 0.27, "extended"), (1.0, 0.27, "extended"), (0.5, 0.0, "mid-stroke"), (1.0, 0.0, "mid-stroke")];

/// A row of the table: what it is, and its text for one analysis.
type Row = (&'static str, fn(&EnergyAnalysis) -> String);

const ROWS: [Row; 12] = [
    ("asymmetry of dH/dt, share of the range off centre", |analysis| format!("{:.2}", asymmetry(trace(analysis)))),
    ("Coulomb friction, W at most", |analysis| watts(peak_of(analysis, "coulomb_friction"))),
    ("damping, W at most", |analysis| watts(peak_of(analysis, "viscous_damping"))),
    ("internal leakage, W at most", |analysis| watts(peak_of(analysis, "internal_leakage"))),
    ("external leakage, W at most", |analysis| watts(peak_of(analysis, "external_leakage"))),
    ("internal leakage away from supply peaks and at them, W", |analysis| near_peaks(analysis, "internal_leakage")),
    ("external leakage away from supply peaks and at them, W", |analysis| near_peaks(analysis, "external_leakage")),
    ("largest lag between the three rates, degrees", |analysis| {
        let largest = analysis.phase_criterion().and_then(|criterion| criterion.largest_degrees);
        largest.map_or("-".to_string(), |degrees| format!("{degrees:.1}"))
    }),
    ("mean supply, W: u > 0 / u < 0", |analysis| by_sign(analysis, |powers| powers.supply)),
    ("mean gain of the oil, W: u > 0 / u < 0", |analysis| by_sign(analysis, |powers| powers.oil)),
    ("mean gain of the link, W: u > 0 / u < 0", |analysis| by_sign(analysis, |powers| powers.links)),
    ("mean loss, W: u > 0 / u < 0", |analysis| by_sign(analysis, |powers| powers.dissipation.map(|power| -power))),
];

/// The table.
pub fn energy_flow() -> Result<String, String> {
    let model = nominal()?;
    let mut analyses = Vec::new();
    for (frequency, start, _) in CASES {
        let recording = Sine { frequency, start, duration: 12.0, tank: 0.0 }.on(&model)?;
        let recording = read(&recording, PRESSURE_NOISE, SEED);
        analyses.push(analyse(&model, &recording, EnergySettings::default()).map_err(|error| error.to_string())?);
    }
    let heads = CASES.map(|(frequency, _, place)| format!("{frequency:.1} Hz, {place}"));
    let mut text = format!("| quantity | {} |\n|---|---|---|---|---|\n", heads.join(" | "));
    for (name, of) in ROWS {
        text += &format!("| {name} | {} |\n", analyses.iter().map(of).collect::<Vec<_>>().join(" | "));
    }
    Ok(text)
}

fn trace(analysis: &EnergyAnalysis) -> &CylinderTraces {
    &analysis.traces.cylinders[0]
}

fn watts(value: f64) -> String {
    figure(value, false)
}

fn asymmetry(trace: &CylinderTraces) -> f64 {
    let rates = trace.analytical.value.iter().filter(|rate| rate.is_finite());
    let (up, down) = rates.fold((0.0_f64, 0.0_f64), |(up, down), &rate| (up.max(rate), down.min(rate)));
    (up + down).abs() / (up - down)
}

/// Powers of an effect over time, W.
fn powers<'a>(analysis: &'a EnergyAnalysis, effect: &str) -> &'a [f64] {
    trace(analysis).terms.iter().find(|term| term.effect == effect).map_or(&[], |term| &term.analytical)
}

fn peak(values: &[f64]) -> f64 {
    values.iter().filter(|value| value.is_finite()).fold(0.0, |peak: f64, value| peak.max(value.abs()))
}

fn peak_of(analysis: &EnergyAnalysis, effect: &str) -> f64 {
    peak(powers(analysis, effect))
}

/// Mean size of an effect's power where the supply is below a tenth of its peak, and where it is above half of it.
fn near_peaks(analysis: &EnergyAnalysis, effect: &str) -> String {
    let (supply, powers) = (&trace(analysis).supply.value, powers(analysis, effect));
    let highest = peak(supply);
    let mean = |is_met: &dyn Fn(f64) -> bool| {
        let own =
            powers.iter().zip(supply).filter(|(power, supply)| power.is_finite() && is_met(supply.abs() / highest));
        let (count, sum) = own.fold((0.0, 0.0), |(count, sum), (power, _)| (count + 1.0, sum + power.abs()));
        watts(sum / count)
    };
    format!("{} / {}", mean(&|share| share < 0.1), mean(&|share| share > 0.5))
}

fn by_sign(analysis: &EnergyAnalysis, of: fn(MeanPowers) -> Option<f64>) -> String {
    let both = ByOpening::of(&analysis.by_opening[0]);
    let text = |powers| of(powers).map_or("-".to_string(), watts);
    format!("{} / {}", text(both.positive), text(both.negative))
}
