//! Time and memory of work in this process and of programs.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// How often the memory of a program is looked at: much more often than a program's memory doubles.
const LOOK: Duration = Duration::from_millis(5);

/// The shortest of several times in s, and the last result. Other work on the machine can only make a run longer.
pub fn best_of<R>(repetitions: usize, mut work: impl FnMut() -> R) -> (f64, R) {
    let mut timed = || {
        let begin = Instant::now();
        let result = work();
        (begin.elapsed().as_secs_f64(), result)
    };
    let mut best = timed();
    for _ in 1..repetitions {
        let next = timed();
        best = (best.0.min(next.0), next.1);
    }
    best
}

/// What a program cost.
#[derive(Debug, Clone)]
pub struct Cost {
    /// Wall time, s.
    pub seconds: f64,
    /// Time of processors, s.
    pub processor_seconds: f64,
    /// Largest resident memory, 10⁶ bytes.
    pub peak_megabytes: f64,
}

/// Runs a program to its end.
///
/// # Errors
/// In words, where it cannot be started or fails; with the last line that it wrote to standard error.
pub fn cost_of(program: &Path, arguments: &[String]) -> Result<Cost, String> {
    let failed = |reason: String| format!("{} {}: {reason}", program.display(), arguments.join(" "));
    let begin = Instant::now();
    let mut child = Command::new(program)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| failed(error.to_string()))?;
    let files = PathBuf::from("/proc").join(child.id().to_string());
    let complaint = child.stderr.take().map(drained);
    let (mut peak_megabytes, mut processor_seconds) = (0.0, 0.0);
    let status = loop {
        peak_megabytes = peak_memory(&files).unwrap_or(peak_megabytes);
        processor_seconds = processor_time(&files).unwrap_or(processor_seconds);
        if let Some(status) = child.try_wait().map_err(|error| failed(error.to_string()))? {
            break status;
        }
        std::thread::sleep(LOOK);
    };
    let seconds = begin.elapsed().as_secs_f64();
    if !status.success() {
        let complaint = complaint.and_then(|thread| thread.join().ok()).unwrap_or_default();
        return Err(failed(complaint.trim().lines().last().unwrap_or("no word why").to_string()));
    }
    Ok(Cost { seconds, processor_seconds, peak_megabytes })
}

/// Reads to the end beside the program, which would otherwise wait for a full pipe.
fn drained(mut from: impl std::io::Read + Send + 'static) -> std::thread::JoinHandle<String> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        // A broken pipe ends the text; the exit status says whether that matters.
        let _ = from.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// `VmHWM` of a process, 10⁶ bytes; `None` when it has ended.
fn peak_memory(files: &Path) -> Option<f64> {
    let status = std::fs::read_to_string(files.join("status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().trim_end_matches(" kB").parse::<f64>().ok().map(|kibibytes| kibibytes * 1024.0 / 1e6)
}

/// Time of processors that a process and its threads have used, s; `None` when it has ended.
pub fn processor_time(files: &Path) -> Option<f64> {
    /// Ticks of the kernel per second in `/proc`; the same on all Linux that this runs on.
    const TICKS: f64 = 100.0;
    let line = std::fs::read_to_string(files.join("stat")).ok()?;
    // Fields after the name, which may have spaces: the state is number 3, user time 14, system time 15.
    let fields: Vec<&str> = line.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field - 3).and_then(|text| text.parse::<f64>().ok());
    Some((ticks(14)? + ticks(15)?) / TICKS)
}
