//! `excavator up`: simulator, energy monitor and recorder in one command, each in a process of its own. A dashboard and a
//! motion are optional.
//!
//! Processes instead of threads: a process has one participant and one node, and each can fail without the others.

mod motion;

use std::os::unix::process::CommandExt;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use crate::cli::UpArguments;
use crate::error::VerbError;
use crate::terminal::print;
use motion::Motion;

use excavator_ros::{Environment, RosArguments, Signals, end_with_this_process};

/// Time for a part to end by itself after the signal.
const FAREWELL: Duration = Duration::from_secs(10);
/// Port of the dashboard if none was given: two machines on one computer then do not collide.
#[cfg(feature = "dashboard")]
const ANY_PORT: u16 = 0;
/// The simulator's model if none is given.
const DEFAULT_MODEL: &str = "zx30u-arm";
/// Polling period for parts that have ended.
const GLANCE: Duration = Duration::from_millis(100);

/// Runs all parts until one ends, a signal comes, or the time is over. Each part receives `ros_words`.
///
/// # Errors
/// [`VerbError`] if a part cannot be started, or ends with a failure.
pub fn run(arguments: &UpArguments, ros_words: &[String]) -> Result<(), VerbError> {
    // Parsed here so that a faulty argument is reported once, and not by each part.
    let (ros, _) = RosArguments::parse(ros_words)?;
    Environment::read(ros.enclave.as_deref())?;
    let signals = Signals::block()?;
    let program = std::env::current_exe()?;
    let motion = arguments.demo.then(|| Motion::of(&model_of(&ros))).transpose()?;
    let mut parts = Vec::new();
    let outcome = start(&program, arguments, motion.as_ref(), ros_words, &mut parts)
        .and_then(|()| watch(&signals, arguments.duration, &mut parts));
    // The recorder ends last, so that it records the end of the others.
    let ends: Vec<Result<(), VerbError>> = parts.iter_mut().rev().map(Part::end).collect();
    outcome?;
    ends.into_iter().collect()
}

/// The model that the simulator is started with.
fn model_of(ros: &RosArguments) -> String {
    let given = ros.parameters.iter().rev().find(|given| given.name == "model");
    let named = given.and_then(|given| given.value.as_text()).filter(|name| !name.is_empty());
    named.unwrap_or(DEFAULT_MODEL).to_string()
}

struct Part {
    name: &'static str,
    child: Child,
}

fn start(
    program: &std::path::Path,
    arguments: &UpArguments,
    motion: Option<&Motion>,
    ros_words: &[String],
    parts: &mut Vec<Part>,
) -> Result<(), VerbError> {
    let mut spawn = |name: &'static str, words: Vec<std::ffi::OsString>| {
        let mut command = Command::new(program);
        // A Ctrl-C in the terminal must reach only this process, which ends its parts one after the other.
        command.args(words).args(ros_words).process_group(0);
        let child = end_with_this_process(&mut command).spawn()?;
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
    // With a motion, the dashboard starts by default.
    #[cfg(feature = "dashboard")]
    if let Some(port) = arguments.dashboard.or(motion.map(|_| ANY_PORT)) {
        spawn("dashboard", vec!["dashboard".into(), "--port".into(), port.to_string().into()])?;
    }
    spawn("energy monitor", vec!["node".into(), "energy-monitor".into()])?;
    spawn("arm simulator", vec!["node".into(), "arm-simulator".into()])?;
    match motion {
        Some(motion) => {
            spawn("joint controller", vec!["node".into(), "joint-controller".into()])?;
            spawn("player", motion.words())
        }
        None => {
            print("The arm obeys arm/orifice_command. `excavator up --demo` moves it by itself.");
            Ok(())
        }
    }
}

/// Waits for the end. If a part ends first, the error names the part and its exit status.
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
    /// Ends the part with a signal, or kills it if it takes too long.
    fn end(&mut self) -> Result<(), VerbError> {
        let start = Instant::now();
        let mut signalled = false;
        loop {
            if let Some(status) = self.child.try_wait()? {
                let failed = || VerbError::PartFailed { part: self.name, status: status.to_string() };
                return if status.success() { Ok(()) } else { Err(failed()) };
            }
            if let (false, Ok(pid)) = (signalled, i32::try_from(self.child.id())) {
                // SIGTERM, because a shell starts background processes with SIGINT ignored. The part may end by itself at this
                // moment.
                let _ = kill(Pid::from_raw(pid), Signal::SIGTERM);
                signalled = true;
            }
            if start.elapsed() > FAREWELL {
                self.child.kill()?;
                let status = self.child.wait()?.to_string();
                return Err(VerbError::PartFailed { part: self.name, status });
            }
            std::thread::sleep(GLANCE);
        }
    }
}
