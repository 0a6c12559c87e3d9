//! SIGINT and SIGTERM as something to wait for.

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use nix::sys::signal::{SigSet, Signal};

use super::RosError;

/// Signals that end this process, waited for on a thread of their own.
pub struct Signals {
    arrived: Mutex<Receiver<Signal>>,
}

impl Signals {
    /// Blocks the signals in this thread, and so in every thread that it starts from now on: an interrupted system call
    /// ends the middleware's threads for good. Call it before anything else is started.
    ///
    /// A second signal while the first is being followed ends the process at once.
    ///
    /// # Errors
    /// [`RosError::System`].
    pub fn block() -> Result<Self, RosError> {
        let failed = |source: nix::Error| RosError::System { action: "block signals", source: source.into() };
        let mut set = SigSet::empty();
        for signal in [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP, Signal::SIGUSR1] {
            set.add(signal);
        }
        set.thread_block().map_err(failed)?;
        let (sender, arrived) = channel();
        std::thread::Builder::new()
            .name("signals".into())
            .spawn(move || {
                let mut ending = false;
                while let Ok(signal) = set.wait() {
                    if ending && signal != Signal::SIGUSR1 {
                        std::process::exit(130);
                    }
                    ending |= signal != Signal::SIGUSR1;
                    if sender.send(signal).is_err() {
                        return;
                    }
                }
            })
            .map_err(|source| RosError::System { action: "start the signal thread", source })?;
        Ok(Signals { arrived: Mutex::new(arrived) })
    }

    /// The next signal within `time`.
    pub fn wait(&self, time: Duration) -> Option<Signal> {
        match self.arrived.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(time) {
            Ok(signal) => Some(signal),
            Err(RecvTimeoutError::Timeout) => None,
            // The thread is gone: nothing will ever come, but the pace of the caller stays.
            Err(RecvTimeoutError::Disconnected) => {
                std::thread::sleep(time);
                None
            }
        }
    }
}
