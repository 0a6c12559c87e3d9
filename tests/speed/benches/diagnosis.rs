//! How long a diagnosis of one case with all effects takes, and how that compares with one simulation of it.
#![allow(clippy::unwrap_used, missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use excavator::demo::{manoeuvre, plant, sealed::Sealed};
use excavator_identification::diagnosis::{DiagnosisSettings, diagnose};
use excavator_identification::regression::{WeakFormSettings, weak_form};
use excavator_model::document::built_in;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Profile, simulate};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// 38 s to fit and 20 s to judge.
fn recordings(sealed: &Sealed, generator: &mut ChaCha8Rng) -> [Recording; 2] {
    let (long, short) = (manoeuvre::identification(), manoeuvre::validation());
    let mut record = |segments: [&Profile; 2], seconds: f64| {
        let segments = segments.into_iter().flat_map(|profile| profile.segments.clone()).collect();
        let profile = Profile { cylinder: "arm".into(), segments };
        plant::record(sealed, &profile, generator).unwrap().part(0.0, seconds)
    };
    [record([&long, &short], 38.0), record([&short, &short], 20.0)]
}

fn diagnosis(criterion: &mut Criterion) {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let whole = Sealed::draw_without_effect(&mut generator).unwrap();
    let lacking = Sealed::draw(&mut generator).unwrap();
    let model = built_in("zx30u-arm").unwrap();
    let settings = DiagnosisSettings::default();
    let mut group = criterion.benchmark_group("38 s + 20 s at 500 Hz");
    group.sample_size(10);
    let [identification, validation] = recordings(&whole, &mut generator);
    group.bench_function("simulate", |bencher| bencher.iter(|| simulate(&whole.truth, &identification).unwrap()));
    group.bench_function("identify", |bencher| {
        bencher.iter(|| weak_form(&model, &[&identification], &WeakFormSettings::default()).unwrap());
    });
    group.bench_function("diagnose, all effects, nothing hidden", |bencher| {
        bencher.iter(|| diagnose(&model, &[&identification], &[&validation], &settings, &|_, _| ()).unwrap());
    });
    let [identification, validation] = recordings(&lacking, &mut generator);
    group.bench_function("diagnose, all effects, one hidden", |bencher| {
        bencher.iter(|| diagnose(&model, &[&identification], &[&validation], &settings, &|_, _| ()).unwrap());
    });
    group.finish();
}

criterion_group!(benches, diagnosis);
criterion_main!(benches);
