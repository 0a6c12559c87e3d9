//! Do intervals cover, and is nothing found where nothing is hidden? On the demo's own machine, many noise draws.

use excavator::demo::{manoeuvre, plant, sealed::Sealed};
use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::{DiagnosisSettings, diagnose};
use excavator_identification::regression::{WeakFormSettings, weak_form};
use excavator_model::document::built_in;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Draws for coverage: with 200, a parameter whose intervals are right falls below 90 % once in 500 runs.
const COVERAGE_DRAWS: usize = 200;

/// Draws for false claims.
const DRAWS: usize = 40;

/// 95 % intervals of every parameter contain the truth in at least 90 % of the draws.
#[test]
#[ignore = "minutes; tests/run --long"]
fn intervals_cover() {
    let model = built_in("zx30u-arm").unwrap();
    let names = model.parameter_names();
    let unknown = model.unknown_parameters();
    let mut covered = vec![0; unknown.len()];
    let mut errors = vec![0.0; unknown.len()];
    // Mean error in standard errors: the share of a miss that is bias rather than an interval too narrow.
    let mut biases = vec![0.0; unknown.len()];
    for draw in 0..COVERAGE_DRAWS {
        let mut generator = ChaCha8Rng::seed_from_u64(1000 + draw as u64);
        let sealed = Sealed::draw_without_effect(&mut generator).unwrap();
        let recording = plant::record(&sealed, &manoeuvre::identification(), &mut generator).unwrap();
        let result = weak_form(&model, &[&recording], &WeakFormSettings::default()).unwrap();
        let truth = sealed.truth.parameter_values();
        for (number, &index) in unknown.iter().enumerate() {
            let (_, parameter) = result.model.parameters().nth(index).unwrap();
            let error = parameter.value - truth[index];
            let standard_error = parameter.standard_error.unwrap();
            covered[number] += usize::from(error.abs() <= parameter.margin_95.unwrap());
            biases[number] += error / standard_error / COVERAGE_DRAWS as f64;
            errors[number] += (error / truth[index]).abs() / COVERAGE_DRAWS as f64;
        }
    }
    for (number, &index) in unknown.iter().enumerate() {
        let share = covered[number] as f64 / COVERAGE_DRAWS as f64;
        println!(
            "{:28} covered {:5.1} %, mean error {:.2} %, bias {:+.2} standard errors",
            names[index],
            100.0 * share,
            100.0 * errors[number],
            biases[number]
        );
    }
    for (number, &index) in unknown.iter().enumerate() {
        assert!(
            covered[number] as f64 >= 0.9 * COVERAGE_DRAWS as f64,
            "{}: {} of {COVERAGE_DRAWS}",
            names[index],
            covered[number]
        );
    }
}

/// On machines that hide nothing, a missing effect is claimed in at most 5 % of the draws.
#[test]
#[ignore = "many minutes; tests/run --long"]
fn nothing_is_found_where_nothing_is_hidden() {
    let model = built_in("zx30u-arm").unwrap();
    let mut claims = 0;
    for draw in 0..DRAWS {
        let mut generator = ChaCha8Rng::seed_from_u64(2000 + draw as u64);
        let sealed = Sealed::draw_without_effect(&mut generator).unwrap();
        let identification = plant::record(&sealed, &manoeuvre::identification(), &mut generator).unwrap();
        let validation = plant::record(&sealed, &manoeuvre::validation(), &mut generator).unwrap();
        let settings = DiagnosisSettings::default();
        let diagnosis = diagnose(&model, &[&identification], &[&validation], &settings, &|_, _| ()).unwrap();
        if diagnosis.verdict.kind != Kind::Adequate {
            let candidates = diagnosis.candidates();
            let first = candidates.first().map(|candidate| candidate.name());
            println!("draw {draw}: {} {first:?}", diagnosis.verdict.kind.name());
            claims += 1;
        }
    }
    println!("{claims} claims in {DRAWS} draws");
    assert!(claims * 20 <= DRAWS, "{claims} of {DRAWS}");
}
