//! The fuzz targets, for a bounded time with a fixed seed: good input with flipped, cut, repeated and inserted bytes.

#![allow(clippy::unwrap_used)]

mod support;

use std::path::Path;

use excavator_bags::{cdr, fuzzing};
use support::{Numbers, state};

fn sample(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

/// A few changes of the kinds that fuzzers make.
fn mutated(good: &[u8], numbers: &mut Numbers) -> Vec<u8> {
    let mut bytes = good.to_vec();
    for _ in 0..1 + numbers.below(6) {
        let at = numbers.below(bytes.len().max(1));
        match numbers.below(6) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << numbers.below(8),
            1 if !bytes.is_empty() => bytes[at] = [0, 0x7f, 0x80, 0xff][numbers.below(4)],
            2 => bytes.truncate(at),
            3 => bytes.insert(at, numbers.below(256) as u8),
            4 => {
                let end = (at + numbers.below(40)).min(bytes.len());
                let part = bytes[at.min(end)..end].to_vec();
                let to = numbers.below(bytes.len() + 1);
                bytes.splice(to..to, part);
            }
            _ => {
                let end = (at + numbers.below(40)).min(bytes.len());
                bytes.drain(at.min(end)..end);
            }
        }
    }
    bytes
}

fn rounds(seeds: &[Vec<u8>], rounds: usize, target: fn(&[u8])) {
    let mut numbers = Numbers(0x5eed_0f00_d15e_a5e5);
    for seed in seeds {
        target(seed);
        (0..rounds).for_each(|_| target(&mutated(seed, &mut numbers)));
    }
}

#[test]
fn messages() {
    rounds(&[cdr::encode(&state(7, &["boom", "arm"])).unwrap(), vec![0; 60]], 5_000, fuzzing::message);
}

#[test]
fn definitions() {
    let idl = b"module p { module msg { typedef double d3[3]; struct Root { @unit(value=\"m\") d3 x; \
                sequence<p::msg::B, 3> b; string<4> s; }; struct B { octet o; unsigned long long t; }; }; };";
    let msg = b"std_msgs/Header header\nfloat64[3] x\nB[<=3] b\nstring<=4 s\nint8 A=3\n==========\nMSG: p/B\nbyte o\nuint64 t";
    rounds(&[idl.to_vec(), msg.to_vec()], 5_000, fuzzing::definition);
}

#[test]
fn maps() {
    let seeds =
        ["samples/joint-states/map.toml", "samples/arm-swing.csv.map.toml", "../config/maps/seal-friction.toml"];
    rounds(&seeds.map(sample), 3_000, fuzzing::map);
}

#[test]
fn tables() {
    let csv: Vec<u8> = sample("samples/arm-swing.csv")[..800].to_vec();
    rounds(&[csv, b"t,x\n0,1\n1,2\n".to_vec()], 5_000, fuzzing::table);
}

#[test]
fn bags() {
    let mcap = sample("samples/arm-swing/arm-swing_0.mcap");
    let sqlite = sample("samples/joint-states/joint-states.db3");
    let packed = zstd::encode_all(&mcap[..], 3).unwrap();
    rounds(&[mcap, sqlite, packed], 150, fuzzing::bag);
}
