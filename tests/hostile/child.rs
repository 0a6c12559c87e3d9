//! The program as a child, with its memory and time watched.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Most memory that a reader may take, MB.
pub const MOST_MEGABYTES: f64 = 200.0;

/// How a run of the program went.
#[derive(Debug)]
pub struct Run {
    /// Exit status; `None` after a signal, an abort among them.
    pub status: Option<i32>,
    pub output: String,
    pub complaint: String,
    /// Most memory at one time, MB (`VmHWM`).
    pub megabytes: f64,
    /// Processor time, s: what else the machine does makes no difference.
    pub seconds: f64,
}

/// Runs `excavator` in `folder`; it is killed, and the test fails, after `most` s of processor time, or ten times as long.
pub fn run(folder: &Path, words: &[&str], most: f64) -> Run {
    // Into files: a pipe that nobody reads would hold the program up.
    let (out, err) = (tempfile::tempfile().unwrap(), tempfile::tempfile().unwrap());
    let start = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_excavator"))
        .args(words)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(out.try_clone().unwrap())
        .stderr(err.try_clone().unwrap())
        .spawn()
        .unwrap();
    let (mut megabytes, mut seconds): (f64, f64) = (0.0, 0.0);
    let status = loop {
        megabytes = megabytes.max(high_water(child.id()).unwrap_or(0.0));
        seconds = seconds.max(processor_time(child.id()).unwrap_or(0.0));
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if seconds > most || start.elapsed().as_secs_f64() > 10.0 * most {
            child.kill().unwrap();
            child.wait().unwrap();
            panic!("{words:?} runs longer than {most} s, {megabytes} MB: {}", text(err));
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    Run { status: status.code(), output: text(out), complaint: text(err), megabytes, seconds }
}

fn high_water(process: u32) -> Option<f64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

/// User and system time of a process so far, s; `/proc/PID/stat` has hundredths, behind the name in brackets.
fn processor_time(process: u32) -> Option<f64> {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
    Some((fields.next()?.parse::<f64>().ok()? + fields.next()?.parse::<f64>().ok()?) / 100.0)
}

fn text(mut file: std::fs::File) -> String {
    use std::io::{Read, Seek};
    file.rewind().unwrap();
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).unwrap();
    String::from_utf8_lossy(&bytes).into_owned()
}

impl Run {
    /// One line on standard error that has these parts, exit status 1, little memory.
    pub fn refused(&self, parts: &[&str]) -> &Run {
        assert_eq!(self.status, Some(1), "{self:?}");
        let lines: Vec<&str> = self.complaint.lines().filter(|line| line.starts_with("excavator: ")).collect();
        assert_eq!(lines.len(), 1, "{self:?}");
        assert!(lines[0].len() < 1000, "{self:?}");
        for part in parts {
            assert!(self.complaint.contains(part), "\"{part}\" is missing: {self:?}");
        }
        assert!(!self.complaint.contains("panicked"), "{self:?}");
        self.is_frugal()
    }

    /// Little memory.
    pub fn is_frugal(&self) -> &Run {
        assert!(self.megabytes < MOST_MEGABYTES, "{self:?}");
        self
    }
}

/// The largest memory and the longest time of several runs, for the table.
pub fn worst(runs: &[Run]) -> [(&'static str, String); 2] {
    let most = |value: fn(&Run) -> f64| runs.iter().map(value).fold(0.0, f64::max);
    [
        ("memory [MB]", format!("{:.0}", most(|run| run.megabytes))),
        ("processor time [s]", format!("{:.2}", most(|run| run.seconds))),
    ]
}
