//! How long a diagnosis of one case with all effects takes, and how that compares with one simulation of it.
#![allow(clippy::unwrap_used, missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use excavator::demo::{manoeuvre, plant, sealed::Sealed};
use excavator_identification::diagnosis::{DiagnosisSettings, diagnose};
use excavator_identification::regression::{WeakFormSettings, weak_form};
use excavator_model::document::built_in;
use excavator_model::simulation::simulate;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn diagnosis(criterion: &mut Criterion) {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let sealed = Sealed::draw_without_effect(&mut generator).unwrap();
    let identification = plant::record(&sealed, &manoeuvre::identification(), &mut generator).unwrap();
    let validation = plant::record(&sealed, &manoeuvre::validation(), &mut generator).unwrap();
    let model = built_in("zx30u-arm").unwrap();
    let mut group = criterion.benchmark_group("27 s + 15 s at 500 Hz");
    group.sample_size(10);
    group.bench_function("simulate", |bencher| bencher.iter(|| simulate(&sealed.truth, &identification).unwrap()));
    group.bench_function("identify", |bencher| {
        bencher.iter(|| weak_form(&model, &[&identification], &WeakFormSettings::default()).unwrap());
    });
    group.bench_function("diagnose, all effects", |bencher| {
        let settings = DiagnosisSettings::default();
        bencher.iter(|| diagnose(&model, &[&identification], &[&validation], &settings, &|_, _| ()).unwrap());
    });
    group.finish();
}

criterion_group!(benches, diagnosis);
criterion_main!(benches);
