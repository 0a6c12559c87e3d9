//! The QoS that a topic was offered with, in the format of rosbag2.

use serde::Serialize;

use crate::ReadLimits;
use crate::yaml::{self, Yaml};

/// Which samples a writer keeps for slow or late readers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum History {
    /// The last `n` samples.
    KeepLast(u32),
    /// All samples, within resource limits.
    KeepAll,
    /// DDS discovery does not transmit it; the usual value in recorded bags.
    Unknown,
}

/// Whether lost samples are retransmitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reliability {
    /// Retransmitted until acknowledged.
    Reliable,
    /// Sent once.
    BestEffort,
}

/// Whether late-joining readers receive earlier samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Durability {
    /// No.
    Volatile,
    /// Yes, from the writer's history.
    TransientLocal,
}

/// The QoS that one publisher of a topic offers. Deadline, lifespan and liveliness are always the ROS 2 defaults.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Qos {
    /// History of samples.
    pub history: History,
    /// Retransmission of lost samples.
    pub reliability: Reliability,
    /// Delivery to late-joining readers.
    pub durability: Durability,
}

impl Qos {
    /// Reliable, volatile, keep last `depth`: the contract of `/arm/state` and `/arm/orifice_command`.
    #[must_use]
    pub fn reliable(depth: u32) -> Self {
        Qos { history: History::KeepLast(depth), reliability: Reliability::Reliable, durability: Durability::Volatile }
    }

    /// The profiles in the YAML text of a bag's `offered_qos_profiles`. Version 9 and later name the policies, earlier
    /// versions number them. Unknown entries are left out: a bag without QoS is still readable.
    #[must_use]
    pub fn list_from_yaml(text: &str) -> Vec<Qos> {
        match yaml::from_str::<Yaml>(text, &ReadLimits::DEFAULT) {
            Ok(Yaml::Sequence(profiles)) => profiles.iter().filter_map(from_value).collect(),
            _ => Vec::new(),
        }
    }

    /// The YAML text of `offered_qos_profiles` in the format of version 9.
    #[must_use]
    pub fn list_to_yaml(profiles: &[Qos]) -> String {
        if profiles.is_empty() {
            return String::new();
        }
        yaml::to_string(&Self::entries(profiles)).unwrap_or_default()
    }

    pub(crate) fn entries(profiles: &[Qos]) -> Vec<QosEntry> {
        profiles.iter().map(|&profile| QosEntry::from(profile)).collect()
    }
}

/// One profile as `metadata.yaml` has it.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct QosEntry {
    history: &'static str,
    depth: u32,
    reliability: &'static str,
    durability: &'static str,
    deadline: Period,
    lifespan: Period,
    liveliness: &'static str,
    liveliness_lease_duration: Period,
    avoid_ros_namespace_conventions: bool,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct Period {
    sec: u64,
    nsec: u64,
}

/// `RMW_DURATION_INFINITE`, 2⁶³ - 1 ns.
const INFINITE: Period = Period { sec: 9_223_372_036, nsec: 854_775_807 };

impl From<Qos> for QosEntry {
    fn from(qos: Qos) -> Self {
        let (history, depth) = match qos.history {
            History::KeepLast(depth) => ("keep_last", depth),
            History::KeepAll => ("keep_all", 0),
            History::Unknown => ("unknown", 0),
        };
        QosEntry {
            history,
            depth,
            reliability: match qos.reliability {
                Reliability::Reliable => "reliable",
                Reliability::BestEffort => "best_effort",
            },
            durability: match qos.durability {
                Durability::Volatile => "volatile",
                Durability::TransientLocal => "transient_local",
            },
            deadline: INFINITE,
            lifespan: INFINITE,
            liveliness: "automatic",
            liveliness_lease_duration: INFINITE,
            avoid_ros_namespace_conventions: false,
        }
    }
}

fn from_value(profile: &Yaml) -> Option<Qos> {
    let policy = |name: &str| -> Option<String> {
        match profile.get(name)? {
            Yaml::String(text) => Some(text.to_lowercase()),
            Yaml::Integer(number) => Some(number.to_string()),
            _ => None,
        }
    };
    let depth = match profile.get("depth") {
        Some(Yaml::Integer(depth)) => u32::try_from(*depth).ok(),
        _ => None,
    };
    // The numbers are defined in rmw/types.h.
    Some(Qos {
        history: match policy("history")?.as_str() {
            "keep_last" | "1" => History::KeepLast(depth.unwrap_or(1)),
            "keep_all" | "2" => History::KeepAll,
            _ => History::Unknown,
        },
        reliability: match policy("reliability")?.as_str() {
            "best_effort" | "2" => Reliability::BestEffort,
            _ => Reliability::Reliable,
        },
        durability: match policy("durability")?.as_str() {
            "transient_local" | "1" => Durability::TransientLocal,
            _ => Durability::Volatile,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_survive_the_round_trip() {
        let profiles = [
            Qos::reliable(50),
            Qos {
                history: History::Unknown,
                reliability: Reliability::BestEffort,
                durability: Durability::TransientLocal,
            },
        ];
        assert_eq!(Qos::list_from_yaml(&Qos::list_to_yaml(&profiles)), profiles);
    }

    #[test]
    fn numbers_of_older_versions_are_understood_and_nonsense_is_left_out() {
        let old = "- history: 1\n  depth: 7\n  reliability: 2\n  durability: 1\n";
        let expected = Qos {
            history: History::KeepLast(7),
            reliability: Reliability::BestEffort,
            durability: Durability::TransientLocal,
        };
        assert_eq!(Qos::list_from_yaml(old), [expected]);
        for nonsense in ["", "[", "42", "- 1\n- {}\n"] {
            assert_eq!(Qos::list_from_yaml(nonsense), []);
        }
    }
}
