//! ROS time: the system clock or `/clock`.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use excavator_msgs::Time;
use excavator_msgs::common::Clock;

use super::{Link, RosError, TopicQos};

/// ROS time; clones share it.
#[derive(Clone, Default)]
pub struct RosClock {
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    /// Whether the time of `/clock` is used.
    follows: AtomicBool,
    /// Whether `/clock` is subscribed.
    listens: AtomicBool,
    /// The newest time from `/clock`, ns.
    simulated: AtomicI64,
}

impl RosClock {
    /// The system clock.
    pub fn system() -> Self {
        RosClock::default()
    }

    /// The clock of a node: `/clock` if `use_sim_time` is set.
    ///
    /// # Errors
    /// [`RosError::Endpoint`].
    pub fn of(link: &Link, use_sim_time: bool) -> Result<Self, RosError> {
        let clock = RosClock::system();
        clock.follow(link, use_sim_time)?;
        Ok(clock)
    }

    /// Switches to `/clock`, or back to the system clock. The subscription of the library expects a type other than
    /// rosgraph_msgs/Clock, so this one is our own.
    ///
    /// # Errors
    /// [`RosError::Endpoint`]; the clock is then unchanged.
    pub(super) fn follow(&self, link: &Link, use_sim_time: bool) -> Result<(), RosError> {
        if use_sim_time && !self.shared.listens.load(Ordering::Relaxed) {
            let newest = Arc::clone(&self.shared);
            link.subscribe("/clock", TopicQos::best_effort(1), move |clock: Clock, _| {
                newest.simulated.store(clock.clock.nanoseconds(), Ordering::Relaxed);
            })?;
            self.shared.listens.store(true, Ordering::Relaxed);
        }
        self.shared.follows.store(use_sim_time, Ordering::Relaxed);
        Ok(())
    }

    /// Now, ns since the epoch; zero before the first `/clock`.
    pub fn nanoseconds(&self) -> i64 {
        if self.shared.follows.load(Ordering::Relaxed) {
            self.shared.simulated.load(Ordering::Relaxed)
        } else {
            system_nanoseconds()
        }
    }

    /// Now.
    pub fn now(&self) -> Time {
        // Timestamps end in 2038. An impossible clock must not stop a node.
        Time::from_nanoseconds(self.nanoseconds()).unwrap_or_default()
    }
}

/// The system clock, ns since the epoch.
pub fn system_nanoseconds() -> i64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .ok()
        .and_then(|elapsed| i64::try_from(elapsed.as_nanos()).ok())
        .unwrap_or_default()
}
