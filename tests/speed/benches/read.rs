//! Reading a bag as a recording, against the bare `mcap` crate on the same file, and from SQLite3.
//!
//! `mcap::MessageStream` decompresses and copies each message but decodes none.
//! The file is `EXCAVATOR_BENCH_BAG` (an `.mcap` with `/arm/state`), or one made here: 40 s at 1 kHz, two cylinders.

#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../../../bags/tests/it/support/mod.rs"]
mod support;

use std::path::{Path, PathBuf};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use excavator_bags::{Topics, read_recording, write_recording};
use rosbag2::{RawMessages, WriteOptions};

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
