//! The QoS that publishers offer, and the QoS that the recorder requests to receive from all of them.

use std::collections::BTreeMap;

use rosbag2::{Durability, History, Qos, Reliability};
use rustdds::discovery::DiscoveredWriterData;
use rustdds::policy;
use rustdds::{QosPolicies, QosPolicyBuilder};

use excavator_ros::dds_names::{ros_topic, ros_type};

/// Most messages that the middleware queues for the recorder: seconds at 1 kHz.
const DEPTH: i32 = 5000;

/// A topic with its publishers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct OfferedTopic {
    /// Full name.
    pub name: String,
    /// ROS type.
    pub type_name: String,
    /// Other types that are published under the same name. They cannot be recorded under it.
    pub other_types: Vec<String>,
    /// One entry per publisher.
    pub qos: Vec<Qos>,
}

/// The ROS topics that these writers offer.
pub(super) fn topics(writers: &[DiscoveredWriterData]) -> Vec<OfferedTopic> {
    let mut topics: BTreeMap<String, OfferedTopic> = BTreeMap::new();
    for writer in writers {
        let data = &writer.publication_topic_data;
        let (Some(name), Some(type_name)) = (ros_topic(&data.topic_name), ros_type(&data.type_name)) else { continue };
        let topic = topics.entry(name.to_string()).or_insert_with(|| OfferedTopic {
            name: name.to_string(),
            type_name: type_name.clone(),
            other_types: Vec::new(),
            qos: Vec::new(),
        });
        if topic.type_name == type_name {
            topic.qos.push(offered(data.reliability, data.durability));
        } else if !topic.other_types.contains(&type_name) {
            topic.other_types.push(type_name);
        }
    }
    topics.into_values().collect()
}

fn offered(reliability: Option<policy::Reliability>, durability: Option<policy::Durability>) -> Qos {
    Qos {
        // Discovery does not transmit the history.
        history: History::Unknown,
        // The DDS default of a writer is reliable.
        reliability: match reliability {
            Some(policy::Reliability::BestEffort) => Reliability::BestEffort,
            _ => Reliability::Reliable,
        },
        durability: match durability {
            None | Some(policy::Durability::Volatile) => Durability::Volatile,
            _ => Durability::TransientLocal,
        },
    }
}

/// The strongest QoS that every publisher of the topic offers: a reader that requests more receives nothing from some of them.
pub(super) fn asked(publishers: &[Qos]) -> QosPolicies {
    let all = |test: fn(&Qos) -> bool| !publishers.is_empty() && publishers.iter().all(test);
    let reliability = if all(|qos| qos.reliability == Reliability::Reliable) {
        policy::Reliability::Reliable { max_blocking_time: rustdds::Duration::ZERO }
    } else {
        policy::Reliability::BestEffort
    };
    let durability = if all(|qos| qos.durability == Durability::TransientLocal) {
        policy::Durability::TransientLocal
    } else {
        policy::Durability::Volatile
    };
    QosPolicyBuilder::new()
        .reliability(reliability)
        .durability(durability)
        .history(policy::History::KeepLast { depth: DEPTH })
        .build()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_asks_for_what_all_can_give() {
        let reliable = Qos::reliable(10);
        let best_effort = Qos { reliability: Reliability::BestEffort, ..reliable };
        let latched = Qos { durability: Durability::TransientLocal, ..reliable };
        let asks = |publishers: &[Qos]| {
            let qos = asked(publishers);
            (matches!(qos.reliability(), Some(policy::Reliability::Reliable { .. })), qos.durability())
        };
        assert_eq!(asks(&[reliable, reliable]), (true, Some(policy::Durability::Volatile)));
        assert_eq!(asks(&[reliable, best_effort]), (false, Some(policy::Durability::Volatile)));
        assert_eq!(asks(&[latched]), (true, Some(policy::Durability::TransientLocal)));
        assert_eq!(asks(&[latched, reliable]), (true, Some(policy::Durability::Volatile)));
    }
}
