//! Runs long work outside the interpreter's lock: progress goes to Python, and Ctrl-C ends the work.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use excavator_study::WorkError;
use excavator_study::results::Progress;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors::of_work;

/// Time between two checks for signals.
const BETWEEN_SIGNALS: Duration = Duration::from_millis(50);

/// Stack of the worker thread, equal to that of a main thread.
const STACK: usize = 8 << 20;

/// A message of the worker thread.
enum Message<T> {
    Progress(String, f64),
    Done(Result<T, WorkError>),
    /// The work panicked, with the panic message.
    Failed(String),
}

/// Payload that unwinds the worker thread after the caller has abandoned it.
struct Abandoned;

/// Runs `work` in a thread of its own, with the interpreter free. `progress` is called in the caller's thread, with the current
/// step and the fraction done. If it raises, or on Ctrl-C, the work is abandoned: the caller returns at once, and the thread
/// ends when it next reports progress.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Progress<'_>) -> Result<T, WorkError> + Send + 'static,
) -> PyResult<T> {
    let (sender, messages) = channel();
    let is_abandoned = Arc::new(AtomicBool::new(false));
    let asked = is_abandoned.clone();
    let body = move || {
        let told = sender.clone();
        let tell = move |what: &str, done: f64| {
            if asked.load(Ordering::Relaxed) {
                // Unwinds without a panic message or a backtrace, because this is not a fault.
                resume_unwind(Box::new(Abandoned));
            }
            drop(told.send(Message::Progress(what.to_string(), done)));
        };
        let outcome = catch_unwind(AssertUnwindSafe(|| work(&tell)));
        // If the caller is gone, the result is dropped.
        drop(sender.send(match outcome {
            Ok(result) => Message::Done(result),
            Err(panic) => Message::Failed(words(&*panic)),
        }));
    };
    std::thread::Builder::new().name("excavator".into()).stack_size(STACK).spawn(body)?;
    let messages = std::sync::Mutex::new(messages);
    let next = || messages.lock().map_or(Err(RecvTimeoutError::Disconnected), |own| own.recv_timeout(BETWEEN_SIGNALS));
    let wait = || -> PyResult<T> {
        loop {
            let message = py.detach(next);
            py.check_signals()?;
            match message {
                Ok(Message::Done(result)) => return result.map_err(of_work),
                Ok(Message::Failed(what)) => return Err(PyRuntimeError::new_err(what)),
                Ok(Message::Progress(what, done)) => {
                    if let Some(progress) = progress {
                        progress.call1((what, done))?;
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(PyRuntimeError::new_err("the work ended by itself")),
            }
        }
    };
    let outcome = wait();
    is_abandoned.store(true, Ordering::Relaxed);
    outcome
}

/// The message of a panic.
fn words(panic: &(dyn Any + Send)) -> String {
    let text =
        panic.downcast_ref::<&str>().map(ToString::to_string).or_else(|| panic.downcast_ref::<String>().cloned());
    format!("a fault of excavator, please report it: {}", text.unwrap_or_default())
}
