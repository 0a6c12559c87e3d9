//! \[B\] in simulation: trapezoids give a model, which predicts sines; dead zones have the sizes of \[B\].

use excavator_identification::characterisation::characterise;
use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_identification::fit::{FitSettings, fit};
use excavator_identification::refinement::{Additions, Refinement, refine};
use excavator_identification::regression::{WeakFormSettings, weak_form};
use excavator_identification::validation::{Comparison, compare};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Profile, Segment, Tolerances, simulate_from_rest};
use rayon::prelude::*;

use crate::experiment::{SEEDS, mean, noisy, with};

/// Samples per second.
const RATE: f64 = 500.0;

/// Full opening of the bench's valve, m².
const FULL: f64 = 1e-4;

/// Dead zones as shares of the full opening: the middles of what \[B\] Section IV-B gives, 0.21 to 0.28 and 0.17 to 0.24. It finds
/// hardly any hysteresis.
const DEAD_ZONES: [f64; 2] = [0.245, 0.205];

/// What the bench has beyond the preliminary model.
const HIDDEN: [(&str, &[f64]); 5] = [
    ("valve_dead_zone", &[DEAD_ZONES[0] * FULL, DEAD_ZONES[1] * FULL]),
    ("valve_directional_gain", &[8e-4, -6e-4]),
    ("valve_leakage", &[4e-13, 5e-13, 4e-13, 6e-13]),
    ("hose_loss", &[4e4]),
    ("coulomb_friction", &[600.0]),
];

/// Displacement before the trapezoids, m.
const START: f64 = -0.13;

/// Signals of Table I of \[B\], and the printed errors by amplitude.
const SIGNALS: [&str; 4] = ["load.displacement", "load.velocity", "load.cap_pressure", "load.rod_pressure"];
const TABLE_ONE: [(f64, [&str; 4]); 3] = [
    (0.27, [".0092", ".0559", ".2052", ".2973"]),
    (0.35, [".0011", ".0104", ".1407", ".1788"]),
    (0.50, [".00058", ".0016", ".144", ".1093"]),
];

fn plant() -> Result<Model, String> {
    let preliminary = built_in("servo-bench").map_err(|error| error.to_string())?;
    HIDDEN.iter().try_fold(preliminary, |model, (effect, values)| with(&model, effect, values))
}

/// Amplitudes 0.25 to 1 in steps of 0.05 in both directions, ramps of 0.5 s (\[B\] IV-A). A plateau is as long as the stroke allows.
fn trapezoids(amplitudes: &[f64]) -> Vec<Segment> {
    let mut segments = Vec::new();
    for amplitude in amplitudes {
        for (sign, zone, travel) in [(1.0, DEAD_ZONES[0], 0.17), (-1.0, DEAD_ZONES[1], 0.14)] {
            let plateau = (travel / (0.42 * (amplitude - zone).max(0.01)) - 0.3).clamp(0.35, 2.5);
            segments.push(Segment::Trapezoid {
                duration: 1.0 + plateau,
                amplitude: sign * amplitude * FULL,
                ramp: 0.5,
            });
            segments.push(Segment::Hold { duration: 1.5, area: 0.0 });
        }
    }
    segments
}

fn sine(amplitude: f64) -> Vec<Segment> {
    vec![Segment::Sine { duration: 4.0 / 0.3, amplitude: amplitude * FULL, frequency: 0.3 }]
}

fn run(plant: &Model, segments: Vec<Segment>, start: f64) -> Result<Recording, String> {
    let profile = Profile { cylinder: "load".into(), segments };
    let samples = (profile.duration() * RATE) as usize;
    let time: Vec<f64> = (0..samples).map(|index| index as f64 / RATE).collect();
    let mut recording = Recording::unmeasured("bench", time, &["load"]);
    recording.pump_pressure.fill(1.2e7);
    let areas: Vec<f64> = recording.time.iter().map(|&time| profile.area(time)).collect();
    recording.cylinders[0].orifice_area.clone_from(&areas);
    recording.cylinders[0].orifice_command = areas;
    simulate_from_rest(plant, &recording, &[start], Tolerances::default().scaled(0.05))
        .map_err(|error| error.to_string())
}

/// The model that the trapezoids give: the five effects, dead zones as read from them, everything else from its usual start.
fn identified(recording: &Recording) -> Result<Model, String> {
    let mut model = built_in("servo-bench").map_err(|error| error.to_string())?;
    let found = characterise(&model, &[recording]).remove(0);
    let read = |positive: bool| {
        let own = found.dead_zones.iter().filter(|(edge, _)| (edge.direction.sign() > 0.0) == positive);
        let zones: Vec<f64> = own.filter_map(|(_, zone)| Some(zone.as_ref().ok()?.dead_zone.value)).collect();
        if zones.is_empty() { Err("the trapezoids show no dead zone".to_string()) } else { Ok(mean(&zones)) }
    };
    let zones = [read(true)?, read(false)?];
    for (effect, _) in HIDDEN {
        model = with(&model, effect, if effect == "valve_dead_zone" { &zones } else { &[] })?;
    }
    let weak = weak_form(&model, &[recording], &WeakFormSettings::default()).map_err(|error| error.to_string())?;
    Ok(fit(&weak.model, &[recording], &FitSettings::default()).map_err(|error| error.to_string())?.model)
}

/// Errors of the sines by amplitude and signal, and values of the hidden effects' parameters.
struct Outcome {
    errors: [[f64; 4]; 3],
    values: Vec<f64>,
}

fn outcome(trapezoids: &Recording, sines: &[Recording; 3], seed: u64) -> Result<Outcome, String> {
    let model = identified(&noisy(trapezoids, seed))?;
    let mut errors = [[f64::NAN; 4]; 3];
    for (place, sine) in sines.iter().enumerate() {
        let mut read = noisy(sine, seed + 100 * (place as u64 + 1));
        // [B] compares velocities too: the true one, as no instrument measures it here.
        read.cylinders[0].velocity.clone_from(&sine.cylinders[0].velocity);
        let comparison = compare(&model, &read).map_err(|error| error.to_string())?;
        errors[place] = SIGNALS.map(|name| {
            let signal = comparison.signals.iter().find(|signal| signal.name == name);
            signal.map_or(f64::NAN, |signal| signal.error.normalised())
        });
    }
    let effects = HIDDEN.iter().filter_map(|(name, _)| model.effects.iter().find(|effect| effect.name() == *name));
    Ok(Outcome { errors, values: effects.flat_map(|effect| &effect.parameters).map(|one| one.value).collect() })
}

/// Table I beside the errors of the simulated bench, and what of the bench was found.
pub fn table_one() -> Result<String, String> {
    let plant = plant()?;
    let amplitudes: Vec<f64> = (0..=15).map(|step| 0.25 + 0.05 * f64::from(step)).collect();
    let trapezoids = run(&plant, trapezoids(&amplitudes), START)?;
    let [one, two, three] = TABLE_ONE.map(|(amplitude, _)| run(&plant, sine(amplitude), 0.0));
    let sines = [one?, two?, three?];
    let all = SEEDS
        .into_par_iter()
        .map(|seed| outcome(&trapezoids, &sines, seed))
        .collect::<Result<Vec<Outcome>, String>>()?;
    let mut text = String::from("| NMSE of the sines | x | v | P1 | P2 |\n|---|---|---|---|---|\n");
    for (place, (amplitude, published)) in TABLE_ONE.into_iter().enumerate() {
        text += &format!("| B = {amplitude}, measured, [B] Table I | {} |\n", published.join(" | "));
        let worst = (0..4).map(|signal| {
            let own = all.iter().map(|one| one.errors[place][signal]);
            format!("{:.1e}", own.fold(0.0, f64::max))
        });
        text += &format!(
            "| B = {amplitude}, simulated, the worst of five seeds | {} |\n",
            worst.collect::<Vec<_>>().join(" | ")
        );
    }
    text += "\n| parameter | in the bench | found: mean of five seeds | largest error, % |\n|---|---|---|---|\n";
    let names: Vec<&str> = HIDDEN
        .iter()
        .filter_map(|(name, _)| plant.effects.iter().find(|effect| effect.name() == *name))
        .flat_map(|effect| effect.parameters.iter().map(|one| &*one.card.name))
        .collect();
    let hidden = HIDDEN.iter().flat_map(|(_, values)| values.iter());
    for (index, (name, hidden)) in names.into_iter().zip(hidden).enumerate() {
        let found: Vec<f64> = all.iter().map(|one| one.values[index]).collect();
        let worst = found.iter().map(|value| 100.0 * (value / hidden - 1.0).abs()).fold(0.0, f64::max);
        text += &format!("| `{name}` | {hidden:.2e} | {:.3e} | {worst:.1} |\n", mean(&found));
    }
    let range = |values: &[f64]| {
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)))
    };
    let (low, high) = range(&trapezoids.cylinders[0].displacement);
    text += &format!(
        "\nThe {} trapezoids take {:.0} s; the piston stays between {low:+.2} and {high:+.2} m of its stroke of ± 0.25 m. At B = 0.27, it moves by {:.1} mm.\n",
        2 * amplitudes.len(),
        trapezoids.time.last().copied().unwrap_or(f64::NAN),
        {
            let (low, high) = range(&sines[0].cylinders[0].displacement);
            1e3 * (high - low)
        },
    );
    Ok(text)
}

/// The search from the preliminary model on four amplitudes: step by step for the first seed, and what it finds for all.
pub fn refinement() -> Result<String, String> {
    let plant = plant()?;
    let trapezoids = run(&plant, trapezoids(&[0.3, 0.5, 0.75, 1.0]), START)?;
    let sines = run(&plant, TABLE_ONE.iter().flat_map(|(amplitude, _)| sine(*amplitude)).collect(), 0.0)?;
    let [first, others @ ..] = SEEDS;
    let refined = refined(&trapezoids, &sines, first)?;
    let mut text = String::from(
        "| `excavator refine --auto`, NMSE on the sines | x | v | P1 | P2 | mean |\n|---|---|---|---|---|---|\n",
    );
    text += &row("preliminary, as given", &refined.given);
    for step in &refined.steps {
        let name = step.added.as_deref().map(|name| format!("+ {}", name.trim_end_matches("@load")));
        text += &row(&name.unwrap_or("preliminary, identified".to_string()), &step.comparisons);
    }
    text += "\n| seed | hidden and found | hidden, not found | found, not hidden | verdict |\n|---|---|---|---|---|\n";
    text += &outcome_row(first, &refined);
    for seed in others {
        text += &outcome_row(seed, &self::refined(&trapezoids, &sines, seed)?);
    }
    Ok(text)
}

fn refined(trapezoids: &Recording, sines: &Recording, seed: u64) -> Result<Refinement, String> {
    let preliminary = built_in("servo-bench").map_err(|error| error.to_string())?;
    let (identification, validation) = (noisy(trapezoids, seed), noisy(sines, seed + 100));
    let (settings, when) = (DiagnosisSettings::default(), "2026-01-01T00:00:00Z");
    refine(&preliminary, &[&identification], &[&validation], &Additions::Auto, &settings, when, &|_, _| ())
        .map_err(|error| error.to_string())
}

/// What one search found.
fn outcome_row(seed: u64, refined: &Refinement) -> String {
    let added = refined.steps.iter().filter_map(|step| step.added.as_deref());
    let added: Vec<&str> = added.map(|name| name.trim_end_matches("@load")).collect();
    let hidden = HIDDEN.map(|(name, _)| name);
    let found = hidden.iter().filter(|name| added.contains(name)).count();
    let list = |names: Vec<String>| if names.is_empty() { "none".to_string() } else { names.join(", ") };
    let of = |names: &[&str], others: &[&str]| {
        list(names.iter().filter(|name| !others.contains(name)).map(|name| format!("`{name}`")).collect())
    };
    let (missed, more) = (of(&hidden, &added), of(&added, &hidden));
    format!("| {seed} | {found} of {} | {missed} | {more} | `{}` |\n", hidden.len(), refined.verdict().name())
}

/// A row of the table: mean errors over the recordings.
fn row(name: &str, comparisons: &[Comparison]) -> String {
    let number = |value: f64| if value < 1e-2 { format!("{value:.1e}") } else { format!("{value:.3}") };
    let signal = |name: &&str| {
        let all = comparisons.iter().flat_map(|one| one.signals.iter().filter(|signal| signal.name == **name));
        number(mean(&all.map(|signal| signal.error.normalised()).collect::<Vec<_>>()))
    };
    let cells: Vec<String> = SIGNALS.iter().map(signal).collect();
    let all = mean(&comparisons.iter().map(Comparison::mean_error).collect::<Vec<_>>());
    format!("| {name} | {} | {} |\n", cells.join(" | "), number(all))
}
