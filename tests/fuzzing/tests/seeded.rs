//! Changed samples through every reader, the same ones every time: nothing panics, hangs, or takes much more memory than
//! the bytes that it was given.
//!
//! A short run belongs to all tests; the long one is `cargo test --workspace --test seeded -- --ignored`.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use excavator_fuzzing::{Mutator, TARGETS, Target};
use nix::time::{ClockId, clock_gettime};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Longest that one input may take, of processor time: good ones take a thousandth.
const LONGEST: Duration = Duration::from_secs(5);
/// How many times as many inputs the long run has.
const LONG: usize = 100;
/// Memory of the process at most, MB, with what SQLite and zstd take, which do not ask Rust for it.
const PROCESS: usize = 2_000;

/// The highest that one input took: memory beyond its bytes' share, and time.
#[derive(Default)]
struct Worst {
    memory: usize,
    share: f64,
    time: Duration,
}

/// What this thread has taken; a busy machine makes no difference.
fn processor_time() -> Duration {
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).unwrap().into()
}

/// One input; whether it made sense. What breaks a rule is kept as a file.
fn run(target: &Target, bytes: &[u8], worst: &mut Worst) -> bool {
    let (per_byte, constant) = target.memory;
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let start = processor_time();
    let outcome = catch_unwind(AssertUnwindSafe(|| (target.run)(bytes)));
    let (took, memory) = (processor_time().saturating_sub(start), MEMORY.peak_usage().saturating_sub(before));
    worst.memory = worst.memory.max(memory);
    worst.share = worst.share.max(memory as f64 / (constant + per_byte * bytes.len()) as f64);
    worst.time = worst.time.max(took);
    let wrong = match outcome {
        Err(_) => "it panicked, see above".to_string(),
        Ok(_) if took > LONGEST => format!("it took {took:.1?}"),
        Ok(_) if memory > constant + per_byte * bytes.len() => {
            format!("it took {memory} bytes of memory, and may take {constant} and {per_byte} for each of its own")
        }
        Ok(understood) => return understood,
    };
    let file = std::env::temp_dir().join(format!("{}-{}.bin", target.name, bytes.len()));
    std::fs::write(&file, bytes).unwrap();
    panic!("{}, {} bytes in {}: {wrong}", target.name, bytes.len(), file.display());
}

/// Held by whoever measures: the allocator counts for all threads.
static ALONE: Mutex<()> = Mutex::new(());

fn hammer(name: &str, times: usize, seed: u64) {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let target = TARGETS.iter().find(|target| target.name == name).unwrap();
    let (seeds, mut worst) = ((target.seeds)(), Worst::default());
    for (number, good) in seeds.iter().enumerate() {
        assert!(run(target, good, &mut worst), "{name}: seed {number} of {} bytes made no sense", good.len());
    }
    let mut mutator = Mutator::new(seed);
    let cases = times * target.cases;
    let understood = (0..cases).filter(|_| run(target, &mutator.changed(&seeds), &mut worst)).count();
    eprintln!(
        "{name}: {understood} of {cases} made sense; at most {:.1} MB ({:.0} % of what may be), {:.1?}",
        worst.memory as f64 / 1e6,
        100.0 * worst.share,
        worst.time
    );
    // Both ways were gone; broken lines do not make a text table or a log senseless.
    let is_text = ["text-table", "can-log"].contains(&name);
    assert!(20 * understood > cases, "only {understood} of {cases} changed inputs made sense");
    assert!(is_text || 50 * (cases - understood) > cases, "{understood} of {cases} changed inputs made sense");
}

macro_rules! targets {
    ($($test:ident $name:literal,)*) => {
        $(#[test]
        fn $test() {
            hammer($name, 1, 0x5eed);
        })*

        mod long {
            $(#[test]
            #[ignore = "takes minutes"]
            fn $test() {
                super::hammer($name, super::LONG, 0x10f6);
                super::check_process();
            })*
        }

        #[test]
        fn every_target_is_run() {
            let run = [$($name),*];
            assert!(TARGETS.iter().all(|target| run.contains(&target.name)), "a target is missing in {run:?}");
        }
    };
}

targets! {
    messages "message",
    schemas "schema",
    maps "map",
    text_tables "text-table",
    matlab_tables "matlab",
    parquet_tables "parquet",
    sheets "sheet",
    mcap_bags "mcap",
    sqlite_bags "sqlite",
    packed_bags "packed",
    can_databases "can-database",
    can_logs "can-log",
    formulas "formula",
    yaml_texts "yaml",
}

/// What SQLite and zstd took is the system's to say.
fn check_process() {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    let megabytes = peak.trim().trim_end_matches("kB").trim().parse::<usize>().unwrap() / 1000;
    eprintln!("the process took {megabytes} MB at most");
    assert!(megabytes < PROCESS, "the process took {megabytes} MB");
}

/// Texts that make careless parsers recurse without end or go over the rest again and again.
#[test]
fn deep_and_long_texts() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let many = |part: &str| part.repeat(60_000 / part.len());
    let texts = [
        ["(", "[", "{", "\"", "\\\"", " \n", "[[", "a.", "a=[", ",", "module m { ", "sequence<", "1e9,"]
            .map(many)
            .to_vec(),
        vec![
            format!("VERSION \"{}", many("\\\"")),
            format!("BO_ 1 M: 8 N\n{}", many(" SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n")),
            format!("[clock]\nrate = 1\n{}", many("[[signals]]\nsignal = \"arm.velocity\"\ncolumn = 1\n")),
        ],
    ]
    .concat();
    for target in TARGETS.iter().filter(|target| !["mcap", "sqlite", "packed"].contains(&target.name)) {
        for text in &texts {
            run(target, text.as_bytes(), &mut Worst::default());
        }
    }
}
