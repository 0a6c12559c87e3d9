//! Identifies the node behind a DDS writer: its name and its addresses.
//!
//! Nodes announce their writers on `ros_discovery_info`. Without DDS Security, anybody can announce anything there.

use std::collections::BTreeMap;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};

use rosbag2::cdr;
use rustdds::discovery::DiscoveredWriterData;
use rustdds::policy::{Durability, History, Reliability};
use rustdds::{QosPolicyBuilder, RTPSEntity};
use serde::Deserialize;

use super::dds_names::dds_topic;
use super::raw::RawInlet;
use super::{Link, RosError};

/// `rmw_dds_common/msg/ParticipantEntitiesInfo`.
#[derive(Debug, Deserialize)]
struct ParticipantEntities {
    participant: [u8; 16],
    nodes: Vec<NodeEntities>,
}

/// `rmw_dds_common/msg/NodeEntitiesInfo`.
#[derive(Debug, Deserialize)]
struct NodeEntities {
    namespace: String,
    name: String,
    #[allow(dead_code)]
    readers: Vec<[u8; 16]>,
    writers: Vec<[u8; 16]>,
}

/// Largest number of participants whose nodes are stored. A network of machines has fewer; the limit bounds the memory.
const MOST_PARTICIPANTS: usize = 512;
/// Largest announcement that is decoded, bytes: a participant with a thousand readers and writers.
const LARGEST_ANNOUNCEMENT: usize = 64 * 1024;

type NodesByWriter = BTreeMap<[u8; 16], String>;

/// The nodes behind the writers of the graph; clones share them.
#[derive(Clone)]
pub struct Peers {
    link: Link,
    nodes: Arc<Mutex<BTreeMap<[u8; 16], NodesByWriter>>>,
}

impl Peers {
    /// Subscribes to the announcements of nodes.
    ///
    /// # Errors
    /// [`RosError::Endpoint`].
    pub fn of(link: &Link) -> Result<Self, RosError> {
        let peers = Peers { link: link.clone(), nodes: Arc::default() };
        let qos = QosPolicyBuilder::new()
            .reliability(Reliability::Reliable { max_blocking_time: rustdds::Duration::ZERO })
            .durability(Durability::TransientLocal)
            .history(History::KeepLast { depth: 1 })
            .build();
        let nodes = Arc::clone(&peers.nodes);
        let type_name = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
        RawInlet::open_dds(link, "ros_discovery_info", type_name, qos, move |sample| take(&nodes, &sample.data))?;
        Ok(peers)
    }

    /// Full name of the node that owns a writer, if the node has announced it.
    pub fn node_of(&self, writer: &[u8; 16]) -> Option<String> {
        let nodes = self.nodes.lock().unwrap_or_else(PoisonError::into_inner);
        nodes.values().find_map(|writers| writers.get(writer).cloned())
    }

    /// Addresses at which the participant of a writer receives packets.
    pub fn addresses_of(&self, writer: &[u8; 16]) -> Vec<IpAddr> {
        let found = self.writers().into_iter().find(|data| identity(data) == *writer);
        let locators = found.map(|data| data.writer_proxy.unicast_locator_list).unwrap_or_default();
        locators.into_iter().map(|locator| SocketAddr::from(locator).ip()).collect()
    }

    /// Whether a writer has left the graph.
    pub fn has_left(&self, writer: &[u8; 16]) -> bool {
        !self.writers().iter().any(|data| identity(data) == *writer)
    }

    /// Writers of other participants on a topic (full name).
    pub fn other_writers(&self, topic: &str) -> Vec<[u8; 16]> {
        let Some(own) = self.link.participant().map(|participant| participant.guid()) else { return Vec::new() };
        let own = ros2_client::Gid::from(own).to_bytes16();
        let name = dds_topic(topic);
        let writers = self.writers().into_iter().filter(|data| data.publication_topic_data.topic_name == name);
        writers.map(|data| identity(&data)).filter(|writer| writer[..12] != own[..12]).collect()
    }

    fn writers(&self) -> Vec<DiscoveredWriterData> {
        self.link.participant().map(|participant| participant.discovered_writers()).unwrap_or_default()
    }
}

fn identity(data: &DiscoveredWriterData) -> [u8; 16] {
    ros2_client::Gid::from(data.publication_topic_data.key).to_bytes16()
}

fn take(nodes: &Mutex<BTreeMap<[u8; 16], NodesByWriter>>, data: &[u8]) {
    if data.len() > LARGEST_ANNOUNCEMENT {
        return;
    }
    let Ok(announced) = cdr::decode::<ParticipantEntities>(data) else { return };
    let mut nodes = nodes.lock().unwrap_or_else(PoisonError::into_inner);
    if nodes.len() >= MOST_PARTICIPANTS && !nodes.contains_key(&announced.participant) {
        return;
    }
    let mut writers = NodesByWriter::new();
    for node in announced.nodes {
        let name = format!("{}/{}", node.namespace.trim_end_matches('/'), node.name);
        writers.extend(node.writers.into_iter().map(|writer| (writer, name.clone())));
    }
    nodes.insert(announced.participant, writers);
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn announcements_name_the_nodes_of_writers() {
        let (participant, reader, writer) = ([1_u8; 16], [2_u8; 16], [3_u8; 16]);
        let nodes = vec![("/pit".to_string(), "operator".to_string(), vec![reader], vec![writer])];
        let data = cdr::encode(&(participant, nodes)).unwrap();
        let known = Mutex::default();
        take(&known, &data);
        take(&known, &data[..40]);
        let known = known.lock().unwrap();
        assert_eq!(known[&participant].get(&writer).map(String::as_str), Some("/pit/operator"));
        assert_eq!(known[&participant].len(), 1);
    }
}
