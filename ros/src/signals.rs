//! Waiting for SIGINT and SIGTERM.

use std::process::Command;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use nix::sys::prctl::set_pdeathsig;
use nix::sys::signal::{SigSet, Signal, kill};
use nix::unistd::{Pid, getpid, getppid};

use super::RosError;

/// Number of requests to end after which the process ends at once.
const AT_ONCE: u32 = 3;
/// Signals within this time count as one request: a terminal signals a whole process group, and a parent in it also
/// signals its children.
const ONE_REQUEST: Duration = Duration::from_millis(500);
/// ID of the process that has started this one and that this one ends with.
const PARENT: &str = "EXCAVATOR_PARENT";

/// Signals that end this process, received by a separate thread.
pub struct Signals {
    arrived: Mutex<Receiver<Signal>>,
}

impl Signals {
    /// Blocks the signals in this thread and in every thread that it starts later, because an interrupted system call
    /// ends the middleware's threads permanently. Call it before anything else is started.
    ///
    /// The caller must act on the first request to end. The second is ignored, since the process is then closing its
    /// files. The third ends the process at once. If the parent has set its process ID ([`end_with_this_process`]),
    /// this process gets SIGTERM when the parent has gone.
    ///
    /// # Errors
    /// [`RosError::System`].
    pub fn block() -> Result<Self, RosError> {
        let failed =
            |action: &'static str| move |source: nix::Error| RosError::System { action, source: source.into() };
        let mut set = SigSet::empty();
        for signal in [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP, Signal::SIGUSR1] {
            set.add(signal);
        }
        set.thread_block().map_err(failed("block signals"))?;
        let (sender, arrived) = channel();
        std::thread::Builder::new()
            .name("signals".into())
            .spawn(move || {
                let mut requests = Requests::default();
                while let Ok(signal) = set.wait() {
                    if signal == Signal::SIGUSR1 || requests.count(Instant::now()) == Some(1) {
                        if sender.send(signal).is_err() {
                            return;
                        }
                    } else if requests.number >= AT_ONCE {
                        std::process::exit(130);
                    }
                }
            })
            .map_err(|source| RosError::System { action: "start the signal thread", source })?;
        let parent = std::env::var(PARENT).ok().and_then(|number| number.parse().ok()).map(Pid::from_raw);
        if let Some(parent) = parent {
            set_pdeathsig(Signal::SIGTERM).map_err(failed("end with the parent"))?;
            // The parent may have ended earlier.
            if getppid() != parent {
                kill(getpid(), Signal::SIGTERM).map_err(failed("end with the parent"))?;
            }
        }
        Ok(Signals { arrived: Mutex::new(arrived) })
    }

    /// The next signal within `time`.
    pub fn wait(&self, time: Duration) -> Option<Signal> {
        match self.arrived.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(time) {
            Ok(signal) => Some(signal),
            Err(RecvTimeoutError::Timeout) => None,
            // The thread has ended and no signal will come, but the caller keeps its pace.
            Err(RecvTimeoutError::Disconnected) => {
                std::thread::sleep(time);
                None
            }
        }
    }
}

/// Makes a child that waits for signals end with this process, however this process ends. Call it on the thread that
/// starts the child and lives as long.
pub fn end_with_this_process(child: &mut Command) -> &mut Command {
    child.env(PARENT, getpid().to_string())
}

/// Counts requests to end.
#[derive(Debug, Default)]
struct Requests {
    number: u32,
    last: Option<Instant>,
}

impl Requests {
    /// Number of the request that comes with a signal; `None` for a signal that belongs to the request before.
    fn count(&mut self, now: Instant) -> Option<u32> {
        if self.last.is_some_and(|last| now.saturating_duration_since(last) < ONE_REQUEST) {
            return None;
        }
        self.last = Some(now);
        self.number += 1;
        Some(self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_burst_of_signals_is_one_request() {
        let start = Instant::now();
        let mut requests = Requests::default();
        let at = |milliseconds| start + Duration::from_millis(milliseconds);
        let counted: Vec<Option<u32>> = [0, 1, 300, 501, 700, 1100].map(|time| requests.count(at(time))).to_vec();
        assert_eq!(counted, [Some(1), None, None, Some(2), None, Some(3)]);
    }
}
