//! Calls into the middleware that may never return.
//!
//! RustDDS waits for itself where its threads end at the wrong moment: a writer that cannot be registered any more is
//! dropped by the very call that holds the lock which the drop asks for (so still in 0.15.1, `create_datawriter`). Nobody may wait for that for ever, so such calls
//! run on threads of their own, which are left behind with what they hold.

use std::sync::mpsc::channel;
use std::thread::Builder;
use std::time::Duration;

/// Time to join the graph and to open all endpoints: twenty times what it takes on a busy machine.
pub(super) const BUILDING: Duration = Duration::from_secs(4);

/// How long something old may take to go before it is left to itself.
pub(super) const FAREWELL: Duration = Duration::from_secs(2);

/// What `work` returns, or `None` where it takes longer than `limit`; what it returns later is dropped where it runs.
pub(super) fn within<T: Send + 'static>(limit: Duration, work: impl FnOnce() -> T + Send + 'static) -> Option<T> {
    let (done, wait) = channel();
    let worker = move || {
        // Nobody listens any more when it was too late.
        let _ = done.send(work());
    };
    // A system without a thread to spare is as good as one that hangs.
    Builder::new().name("patience".into()).spawn(worker).ok()?;
    wait.recv_timeout(limit).ok()
}

/// Drops something, and waits for that only so long.
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
