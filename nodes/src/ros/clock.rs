//! ROS time: the system's clock, or `/clock`.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use excavator_msgs::Time;
use excavator_msgs::common::Clock;

use super::{Link, RosError, TopicQos};

/// No `/clock` has come yet.
const NOTHING: i64 = i64::MIN;

/// ROS time; clones share it.
#[derive(Clone)]
pub struct RosClock {
    simulated: Option<Arc<AtomicI64>>,
}

impl RosClock {
    /// The system's clock.
    pub fn system() -> Self {
        RosClock { simulated: None }
    }

    /// The clock of a node: `/clock` where `use_sim_time` is set. The library's own subscription asks for another type
    /// than rosgraph_msgs/Clock, so this one is ours.
    ///
    /// # Errors
    /// [`RosError::Endpoint`].
    pub fn of(link: &Link, use_sim_time: bool) -> Result<Self, RosError> {
        if !use_sim_time {
            return Ok(RosClock::system());
        }
        let simulated = Arc::new(AtomicI64::new(NOTHING));
        let newest = Arc::clone(&simulated);
        link.subscribe("/clock", TopicQos::best_effort(1), move |clock: Clock, _| {
            newest.store(clock.clock.nanoseconds(), Ordering::Relaxed);
        })?;
        Ok(RosClock { simulated: Some(simulated) })
    }

    /// Now, ns since the epoch; zero before the first `/clock`.
    pub fn nanoseconds(&self) -> i64 {
        match &self.simulated {
            Some(simulated) => match simulated.load(Ordering::Relaxed) {
                NOTHING => 0,
                now => now,
            },
            None => system_nanoseconds(),
        }
    }

    /// Now.
    pub fn now(&self) -> Time {
        // Stamps end in 2038; an impossible clock must not stop a node.
        Time::from_nanoseconds(self.nanoseconds()).unwrap_or_default()
    }
}

/// The system's clock, ns since the epoch.
pub(crate) fn system_nanoseconds() -> i64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .ok()
        .and_then(|elapsed| i64::try_from(elapsed.as_nanos()).ok())
        .unwrap_or_default()
}
