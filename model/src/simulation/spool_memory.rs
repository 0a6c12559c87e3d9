//! Cache of spool estimates.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, LazyLock};

use quick_cache::Weighter;
use quick_cache::sync::Cache;

/// Number of cached estimates. A diagnosis asks about eighty times for each of about ten recordings and parts of
/// these.
const KEPT: usize = 64;

/// Largest total number of their samples, 64 MB: ten recordings of half an hour at 500 Hz.
const KEPT_SAMPLES: u64 = 8_000_000;

#[derive(Clone)]
struct BySamples;

impl Weighter<[u64; 3], Arc<[f64]>> for BySamples {
    fn weight(&self, _: &[u64; 3], estimate: &Arc<[f64]>) -> u64 {
        estimate.len() as u64
    }
}

static MEMORY: LazyLock<Cache<[u64; 3], Arc<[f64]>, BySamples>> =
    LazyLock::new(|| Cache::with_weighter(KEPT, KEPT_SAMPLES, BySamples));

/// The result of `estimate` for these signals, cached: every fit of every candidate needs the same estimate, which
/// takes as long as a tenth of a fit.
pub(super) fn remembered(
    time: &[f64],
    measured: &[f64],
    command: &[f64],
    estimate: impl FnOnce() -> Vec<f64>,
) -> Vec<f64> {
    // Keys of 192 bits: a collision of two recordings will not happen.
    let key = [time, measured, command].map(fingerprint);
    let known: Result<Arc<[f64]>, std::convert::Infallible> = MEMORY.get_or_insert_with(&key, || Ok(estimate().into()));
    match known {
        Ok(known) => known.to_vec(),
    }
}

fn fingerprint(signal: &[f64]) -> u64 {
    let mut hasher = DefaultHasher::new();
    signal.len().hash(&mut hasher);
    for value in signal {
        hasher.write_u64(value.to_bits());
    }
    hasher.finish()
}
