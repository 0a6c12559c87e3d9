//! `excavator up`: simulator, energy monitor and recorder in one command, each in a process of its own.
//!
//! Processes, not threads: a process has one participant and one node, and one of them can fail without the others.

use std::process::{Child, Command};
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use crate::cli::UpArguments;
use crate::error::VerbError;
use crate::ros::{Environment, RosArguments, Signals};

/// Time that a part has to end in good order.
const FAREWELL: Duration = Duration::from_secs(10);
/// Pace of looking whether a part has ended.
const GLANCE: Duration = Duration::from_millis(100);

/// Runs all parts until one ends, a signal comes, or the time is over; `ros_words` go to each of them.
///
/// # Errors
/// [`VerbError`] when a part cannot be started, or ends by itself with a failure.
pub fn run(arguments: &UpArguments, ros_words: &[String]) -> Result<(), VerbError> {
    // What the parts would refuse one after the other is refused here once.
    let (ros, _) = RosArguments::parse(ros_words)?;
    Environment::read(ros.enclave.as_deref())?;
    let signals = Signals::block()?;
    let program = std::env::current_exe()?;
    let mut parts = Vec::new();
    let outcome = start(&program, arguments, ros_words, &mut parts)
        .and_then(|()| watch(&signals, arguments.duration, &mut parts));
    // The recorder last, so that it hears the end of the others.
    for part in parts.iter_mut().rev() {
        part.end();
    }
    outcome
}

struct Part {
    name: &'static str,
    child: Child,
}

fn start(
    program: &std::path::Path,
    arguments: &UpArguments,
    ros_words: &[String],
    parts: &mut Vec<Part>,
) -> Result<(), VerbError> {
    let mut spawn = |name: &'static str, words: Vec<std::ffi::OsString>| {
        let child = Command::new(program).args(words).args(ros_words).spawn()?;
        parts.push(Part { name, child });
        Ok::<(), VerbError>(())
    };
    if !arguments.no_record {
        let mut words: Vec<std::ffi::OsString> = vec!["record".into(), "--all".into()];
        if let Some(output) = &arguments.output {
            words.extend(["--output".into(), output.clone().into_os_string()]);
        }
        spawn("recorder", words)?;
    }
    spawn("energy monitor", vec!["node".into(), "energy-monitor".into()])?;
    spawn("arm simulator", vec!["node".into(), "arm-simulator".into()])
}

/// Waits for the end; says which part ended first and how.
fn watch(signals: &Signals, duration: Option<f64>, parts: &mut [Part]) -> Result<(), VerbError> {
    let end = duration.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()).map(|time| Instant::now() + time);
    loop {
        if signals.wait(GLANCE).is_some_and(|signal| signal != Signal::SIGUSR1)
            || end.is_some_and(|end| Instant::now() >= end)
        {
            return Ok(());
        }
        for part in parts.iter_mut() {
            if let Some(status) = part.child.try_wait()? {
                return Err(VerbError::PartEnded { part: part.name, status: status.to_string() });
            }
        }
    }
}

impl Part {
    fn end(&mut self) {
        let Ok(pid) = i32::try_from(self.child.id()) else { return };
        if !matches!(self.child.try_wait(), Ok(None)) {
            return;
        }
        // It may end by itself at this very moment; then there is nobody to be told.
        let _ = kill(Pid::from_raw(pid), Signal::SIGINT);
        let start = Instant::now();
        while start.elapsed() < FAREWELL {
            if !matches!(self.child.try_wait(), Ok(None)) {
                return;
            }
            std::thread::sleep(GLANCE);
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
