//! Runs calls into the middleware that may never return.
//!
//! RustDDS can deadlock with itself when its threads end at the wrong moment. If a writer can no longer be registered,
//! it is dropped by the call that already holds the lock which the drop needs (still so in 0.15.1,
//! `create_datawriter`). No caller may wait for that forever. Such calls run on threads of their own, which are
//! abandoned with everything they hold.

use std::sync::mpsc::channel;
use std::thread::Builder;
use std::time::Duration;

/// Time to join the graph and open all endpoints: twenty times what it takes on a busy machine.
pub(super) const BUILDING: Duration = Duration::from_secs(4);

/// Time that dropping an old value may take before its thread is abandoned.
pub(super) const FAREWELL: Duration = Duration::from_secs(2);

/// Returns the result of `work`, or `None` if it takes longer than `limit`. A later result is dropped on its own
/// thread.
pub(super) fn within<T: Send + 'static>(limit: Duration, work: impl FnOnce() -> T + Send + 'static) -> Option<T> {
    let (done, wait) = channel();
    let worker = move || {
        // After the limit, nobody receives the result.
        let _ = done.send(work());
    };
    // If no thread can be started, the call is treated as one that hangs.
    Builder::new().name("patience".into()).spawn(worker).ok()?;
    wait.recv_timeout(limit).ok()
}

/// Drops a value, and waits only for a limited time.
pub(super) fn let_go(thing: impl Send + 'static) {
    let _ = within(FAREWELL, move || drop(thing));
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use std::sync::mpsc::sync_channel;
    use std::time::Instant;

    use super::*;

    const SHORT: Duration = Duration::from_millis(50);

    #[test]
    fn what_returns_in_time_is_returned() {
        assert_eq!(within(Duration::from_secs(60), || 7), Some(7));
    }

    #[test]
    fn what_hangs_is_left_behind_and_what_it_returns_late_is_dropped() {
        struct Dropped(std::sync::mpsc::SyncSender<()>);
        impl Drop for Dropped {
            fn drop(&mut self) {
                let _ = self.0.send(());
            }
        }
        let (gone, wait) = sync_channel(1);
        let (go_on, hang) = sync_channel::<()>(1);
        let start = Instant::now();
        let returned = within(SHORT, move || {
            let _ = hang.recv();
            Dropped(gone)
        });
        assert!(returned.is_none() && start.elapsed() >= SHORT);
        assert!(wait.try_recv().is_err(), "nothing was returned yet");
        go_on.send(()).unwrap();
        assert!(wait.recv_timeout(Duration::from_secs(60)).is_ok());
    }

    #[test]
    fn a_panic_is_no_answer() {
        assert_eq!(within(Duration::from_secs(60), || -> u8 { panic!("on purpose") }), None);
    }
}
