//! Everything that reads other people's bytes, as fuzz targets: each takes any bytes, must return, and says whether they
//! made sense.
//!
//! Two things run them: `tests/seeded.rs` on any toolchain, with changed samples from a fixed seed and a bound on memory and
//! time, and `fuzz/` under libFuzzer, without end.

mod mutation;
mod samples;
mod targets;

pub use mutation::Mutator;
pub use targets::{TARGETS, Target};

/// Runs the target of this name.
///
/// # Panics
/// When the target does, or there is none: that is what a fuzzer looks for.
pub fn run(name: &str, bytes: &[u8]) {
    let target = TARGETS.iter().find(|target| target.name == name);
    assert!(target.is_some(), "there is no target {name}");
    if let Some(target) = target {
        (target.run)(bytes);
    }
}
