//! Boom and arm move at once and something is missing at one of them: the verdict names the effect and the cylinder.
//!
//! The machine is integrated at a twentieth of the usual tolerance, with parameters up to an eighth away from the ones that
//! the diagnosis begins with, and seen by noisy instruments without speed, angle and force sensors.

use crate::common::{measure, off_the_data_sheet, with};
use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::{Candidate, Diagnosis, DiagnosisSettings, diagnose};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::Site;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const RATE: f64 = 500.0;
/// Displacements at the start, m: the middle of what boom and arm work over.
const START: [f64; 2] = [0.05, 0.05];
/// Time with which a spool follows its command, s.
const SERVO: f64 = 0.012;

/// An effect of the machine that the model has not.
type Hidden = (&'static str, Site, &'static [f64]);

const BOOM: Site = Site::Cylinder(0);
const ARM: Site = Site::Cylinder(1);

fn machine(hidden: &[Hidden]) -> Model {
    let nominal = off_the_data_sheet("zx30u", 0.12);
    hidden.iter().fold(nominal, |model, &(name, site, values)| with(&model, name, site, values))
}

/// Openings in m² of a joint: two sines and trapezoids with pauses, which the other joint has at other times.
fn command(joint: usize, manoeuvre: usize, time: f64) -> f64 {
    let rate = [[0.31, 0.83], [0.43, 1.07]][joint][0] * [1.0, 1.3][manoeuvre];
    let fast = [[0.31, 0.83], [0.43, 1.07]][joint][1] * [1.0, 0.8][manoeuvre];
    let turn = std::f64::consts::TAU;
    let place = (time + 3.1 * joint as f64).rem_euclid(11.0);
    match place {
        ..6.0 => 6e-5 * (turn * rate * time).sin() + 3e-5 * (turn * fast * time).sin(),
        ..6.8 => 0.0,
        ..7.8 => 1e-4 * f64::min(1.0, ((place - 6.8) * 8.0).min((7.8 - place) * 8.0)),
        ..8.6 => 0.0,
        ..9.6 => -1e-4 * f64::min(1.0, ((place - 8.6) * 8.0).min((9.6 - place) * 8.0)),
        _ => 0.0,
    }
}

/// What happens without noise; slow drift is steered away, as an operator would.
fn run(model: &Model, manoeuvre: usize, duration: f64) -> Recording {
    let time: Vec<f64> = (0..(duration * RATE) as usize).map(|index| index as f64 / RATE).collect();
    let mut recording = Recording::unmeasured("two joints", time, &["boom", "arm"]);
    recording.tank_pressure.fill(6e5);
    recording.pump_flow.fill(7.6e-4);
    for (joint, cylinder) in recording.cylinders.iter_mut().enumerate() {
        cylinder.orifice_area = recording.time.iter().map(|&t| command(joint, manoeuvre, t)).collect();
    }
    for _ in 0..4 {
        let happened = simulate_from_rest(model, &recording, &START, Tolerances::default()).unwrap();
        for (joint, cylinder) in recording.cylinders.iter_mut().enumerate() {
            let place = &happened.cylinders[joint].displacement;
            let window = (4.0 * RATE) as usize;
            for index in 0..place.len() {
                let (low, high) = (index.saturating_sub(window / 2), (index + window / 2).min(place.len() - 1));
                let drift = (place[high] - place[low]) / ((high - low) as f64 / RATE);
                let away = place[low..=high].iter().sum::<f64>() / (high - low + 1) as f64 - START[joint];
                let area = cylinder.orifice_area[index];
                // 1e-4 m2 moves a piston by about 0.1 m/s; a resting valve is left at rest.
                if area.abs() > 1e-6 {
                    cylinder.orifice_area[index] -= 0.7e-3 * drift + 1e-4 * away;
                }
            }
        }
    }
    for cylinder in &mut recording.cylinders {
        let (commanded, mut spool) = (cylinder.orifice_area.clone(), 0.0);
        for (area, wanted) in cylinder.orifice_area.iter_mut().zip(&commanded) {
            spool += (wanted - spool) * (1.0 - (-1.0 / (RATE * SERVO)).exp());
            *area = spool;
        }
        cylinder.orifice_command = commanded;
    }
    simulate_from_rest(model, &recording, &START, Tolerances::default().scaled(0.05)).unwrap()
}

fn measured(model: &Model, manoeuvre: usize, duration: f64) -> Recording {
    let mut recording = run(model, manoeuvre, duration);
    let mut random = ChaCha8Rng::seed_from_u64(7 + manoeuvre as u64);
    for cylinder in &recording.cylinders {
        let range = cylinder.displacement.iter().fold((9.0_f64, -9.0_f64), |(l, h), &s| (l.min(s), h.max(s)));
        println!("{} moves from {:+.3} m to {:+.3} m", cylinder.name, range.0, range.1);
    }
    measure(&mut random, &mut recording);
    recording
}

fn diagnosed(hidden: &[Hidden]) -> Diagnosis {
    let plant = machine(hidden);
    let (identification, validation) = (measured(&plant, 0, 38.0), measured(&plant, 1, 20.0));
    let begin = std::time::Instant::now();
    let diagnosis = diagnose(
        &built_in("zx30u").unwrap(),
        &[&identification],
        &[&validation],
        &DiagnosisSettings::default(),
        &|_, _| (),
    )
    .unwrap();
    let tied: Vec<String> = diagnosis.alternatives().iter().map(|(other, _)| found_label(other)).collect();
    let selected: Vec<String> = diagnosis.selected().iter().map(found_label).collect();
    println!(
        "{hidden:?}\n  {}: {selected:?}, tied {tied:?}, log error ratio {:.2} -> {:.2}, {:.0} s",
        diagnosis.verdict.kind.name(),
        diagnosis.verdict.standings[0].log_error_ratio,
        diagnosis.verdict.standings[diagnosis.verdict.best].log_error_ratio,
        begin.elapsed().as_secs_f64()
    );
    diagnosis
}

/// Name and place of what was found, as [`label`] has them of what is hidden.
fn found_label(candidate: &Candidate<'_>) -> String {
    format!("{}@{}", candidate.name(), candidate.place())
}

/// Name and place, as `valve_dead_zone@boom`.
fn label((name, site, _): &Hidden) -> String {
    let place = match site {
        Site::Cylinder(index) => ["boom", "arm"][*index],
        Site::PumpLine => "pump",
        Site::Machine => "machine",
    };
    format!("{name}@{place}")
}

#[test]
#[ignore = "minutes; tests/run --long"]
fn nothing_is_missed_where_nothing_is_missing() {
    let diagnosis = diagnosed(&[]);
    assert_eq!(diagnosis.verdict.kind, Kind::Adequate);
    // Noise, and nothing that has to be excused.
    let left = diagnosis.verdict.standings[0].log_error_ratio;
    assert!(left.abs() < 0.1, "{left}");
}

#[test]
#[ignore = "minutes; tests/run --long"]
fn the_effect_and_its_cylinder_are_named() {
    let cases: &[&[Hidden]] = &[
        &[("valve_dead_zone", BOOM, &[4e-6, 3e-6])],
        &[("stribeck_friction", ARM, &[400.0, 0.01])],
        &[("hose_loss", BOOM, &[4e5])],
        &[("pressure_sensor_offset", ARM, &[1e5, 0.0])],
        &[("valve_hysteresis", BOOM, &[4e-6, 1.0])],
        &[("entrained_air", ARM, &[0.02])],
        &[("asymmetric_friction", BOOM, &[2000.0])],
        &[("valve_leakage", ARM, &[3e-12, 2e-12, 3e-12, 2e-12])],
        &[("pump_leakage", Site::PumpLine, &[2e-11])],
        &[("external_contact", BOOM, &[8.0, 3.0, 1500.0])],
        &[("valve_dead_zone", ARM, &[4e-6, 3e-6]), ("hose_loss", BOOM, &[4e5])],
    ];
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|hidden| {
            let diagnosis = diagnosed(hidden);
            let mut found: Vec<String> = diagnosis.selected().iter().map(found_label).collect();
            let mut wanted: Vec<String> = hidden.iter().map(label).collect();
            found.sort_unstable();
            wanted.sort_unstable();
            let tied = diagnosis.verdict.set.len();
            let right = diagnosis.verdict.kind == Kind::MissingEffect && found == wanted && tied <= 2;
            (!right).then(|| format!("{wanted:?}: {} {found:?}, {tied} tied", diagnosis.verdict.kind.name()))
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}
