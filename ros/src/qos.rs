//! Quality of service of topics.

use rustdds::policy::{Durability, History, Lifespan, Reliability, ResourceLimits};
use rustdds::{Duration, QosPolicies, QosPolicyBuilder};

/// Unacknowledged samples that a reliable writer holds before it refuses new ones: one minute at 1 kHz. A reader that
/// hangs blocks the others only after that. It is considered dead long before (10 s with Cyclone DDS, 20 s with Fast
/// DDS).
const UNACKNOWLEDGED: i32 = 60_000;

/// Depth of the queues of a service: rmw_qos_profile_services_default.
pub(super) const SERVICE_DEPTH: u32 = 10;

/// QoS that an endpoint offers or requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TopicQos {
    /// Samples kept.
    pub depth: u32,
    /// Whether lost samples are sent again.
    pub reliable: bool,
    /// Whether late joiners get the last samples.
    pub transient_local: bool,
    /// Seconds after which a sample expires, `None` for never.
    pub lifespan: Option<u32>,
    /// Number of samples that a reliable endpoint can hold.
    pub room: i32,
}

impl TopicQos {
    /// Reliable, volatile, history of `depth` samples.
    pub const fn reliable(depth: u32) -> Self {
        TopicQos { depth, reliable: true, transient_local: false, lifespan: None, room: UNACKNOWLEDGED }
    }

    /// The same for a reader that only needs the newest sample: the middleware keeps read samples until this many are
    /// stored.
    #[must_use]
    pub const fn with_room(self, samples: i32) -> Self {
        TopicQos { room: samples, ..self }
    }

    /// Reliable, the last sample is also sent to late joiners.
    pub const fn latched() -> Self {
        TopicQos { depth: 1, reliable: true, transient_local: true, lifespan: None, room: UNACKNOWLEDGED }
    }

    /// Best effort, volatile.
    pub const fn best_effort(depth: u32) -> Self {
        TopicQos { depth, reliable: false, transient_local: false, lifespan: None, room: UNACKNOWLEDGED }
    }

    /// As DDS policies.
    pub fn to_dds(self) -> QosPolicies {
        // No blocking: a writer that waits for a slow reader would stop its control loop.
        let reliability = if self.reliable {
            Reliability::Reliable { max_blocking_time: Duration::ZERO }
        } else {
            Reliability::BestEffort
        };
        let durability = if self.transient_local { Durability::TransientLocal } else { Durability::Volatile };
        let lifespan = self
            .lifespan
            .map_or(Duration::INFINITE, |seconds| Duration::from_secs(seconds.try_into().unwrap_or(i32::MAX)));
        let depth = i32::try_from(self.depth).unwrap_or(i32::MAX);
        let builder = QosPolicyBuilder::new()
            .reliability(reliability)
            .durability(durability)
            .lifespan(Lifespan { duration: lifespan })
            .history(History::KeepLast { depth });
        let builder = if self.reliable {
            builder.resource_limits(ResourceLimits {
                max_samples: self.room,
                max_instances: 1,
                max_samples_per_instance: self.room,
            })
        } else {
            builder
        };
        builder.build()
    }
}
