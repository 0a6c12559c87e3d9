//! Reading a bag as a recording, against the bare `mcap` crate on the same file, and from SQLite3.
//!
//! The bar is half the speed of `mcap::MessageStream`, which decompresses and copies each message but decodes none.
//! The file is `EXCAVATOR_BENCH_BAG` (an `.mcap` with `/arm/state`), or one made here: 40 s at 1 kHz, two cylinders.

#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../tests/support/mod.rs"]
mod support;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use excavator_bags::{RawMessages, Topics, WriteOptions, read_recording, write_recording};

/// Runs that the ratio is the median of.
const RUNS: usize = 15;

fn bare(file: &Path) -> usize {
    let bytes = std::fs::read(file).unwrap();
    mcap::MessageStream::new(&bytes)
        .unwrap()
        .map(|message| message.unwrap().data.len())
        .filter(|&length| length > 0)
        .count()
}

fn raw(file: &Path) -> usize {
    RawMessages::open(file).unwrap().map(|message| message.unwrap().data.len()).filter(|&length| length > 0).count()
}

fn decoded(file: &Path) -> usize {
    read_recording(file, &Topics::default()).unwrap().0.len()
}

fn median_time(run: impl Fn() -> usize) -> Duration {
    let mut times: Vec<Duration> = (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            assert!(run() > 0);
            start.elapsed()
        })
        .collect();
    times.sort();
    times[RUNS / 2]
}

fn read(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().unwrap();
    let file = std::env::var_os("EXCAVATOR_BENCH_BAG").map(PathBuf::from).unwrap_or_else(|| {
        let bag = folder.path().join("bag");
        write_recording(&bag, &support::recording(40_000), &Topics::default(), &WriteOptions::default()).unwrap();
        support::mcap_file(&bag)
    });
    let database = folder.path().join("bag.db3");
    support::to_sqlite(&file, &database);
    let messages = bare(&file);
    let (bare_time, decoded_time) = (median_time(|| bare(&file)), median_time(|| decoded(&file)));
    println!(
        "{messages} messages: mcap crate {:.2} M/s, decoded to a recording {:.2} M/s, ratio {:.2} (bar: 0.5)",
        messages as f64 / bare_time.as_secs_f64() / 1e6,
        messages as f64 / decoded_time.as_secs_f64() / 1e6,
        bare_time.as_secs_f64() / decoded_time.as_secs_f64()
    );
    let mut group = criterion.benchmark_group("read");
    group.sample_size(20).throughput(Throughput::Elements(messages as u64));
    group.bench_function("mcap_message_stream", |bencher| bencher.iter(|| bare(&file)));
    group.bench_function("raw_messages", |bencher| bencher.iter(|| raw(&file)));
    group.bench_function("recording", |bencher| bencher.iter(|| decoded(&file)));
    group.bench_function("sqlite_raw_messages", |bencher| bencher.iter(|| raw(&database)));
    group.bench_function("sqlite_recording", |bencher| bencher.iter(|| decoded(&database)));
    group.finish();
}

criterion_group!(benches, read);
criterion_main!(benches);
