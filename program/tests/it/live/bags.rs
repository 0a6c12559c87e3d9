//! What a bag has, also while it is being written.

use std::path::Path;

use excavator_msgs::ArmState;
use rosbag2::RawMessage;

use super::until;

/// All messages of a topic: log time in s after the first message of the bag, and content.
pub fn messages<M: excavator_msgs::Message>(bag: &Path, topic: &str) -> Vec<(f64, M)> {
    let all = rosbag2::RawMessages::open(bag).unwrap().map(Result::unwrap);
    of_topic(all, topic)
}

/// The same for a bag that is being written, or does not exist yet: what has reached the disk.
pub fn messages_so_far<M: excavator_msgs::Message>(bag: &Path, topic: &str) -> Vec<(f64, M)> {
    let Ok(found) = rosbag2::RawMessages::open(bag) else { return Vec::new() };
    of_topic(found.flatten(), topic)
}

fn of_topic<M: excavator_msgs::Message>(all: impl Iterator<Item = RawMessage>, topic: &str) -> Vec<(f64, M)> {
    let mut start = None;
    let mut found = Vec::new();
    for message in all {
        let start = *start.get_or_insert(message.log_time);
        if message.topic.name == topic {
            let time = (message.log_time as f64 - start as f64) * 1e-9;
            found.push((time, rosbag2::cdr::decode(&message.data).unwrap()));
        }
    }
    found
}

/// Stamps of the states in a bag so far, s since the epoch, and the openings of the arm's valve.
pub fn openings(bag: &Path) -> Vec<(f64, f64)> {
    let states: Vec<(f64, ArmState)> = messages_so_far(bag, "/arm/state");
    let stamp = |state: &ArmState| state.header.stamp.nanoseconds() as f64 * 1e-9;
    states.iter().map(|(_, state)| (stamp(state), state.cylinders[0].orifice_area)).collect()
}

/// Number of messages of a topic so far, in a bag that may not exist yet.
pub fn recorded(bag: &Path, topic: &str) -> usize {
    let Ok(found) = rosbag2::RawMessages::open(bag) else { return 0 };
    found.flatten().filter(|message| message.topic.name == topic).count()
}

/// Waits until `more` messages of a topic have reached the bag beyond those that it has now: then writer and recorder have found
/// each other, and what is published from here on is recorded.
pub fn records(bag: &Path, topic: &str, more: usize) {
    let before = recorded(bag, topic);
    until(&format!("{more} messages of {topic} in {}", bag.display()), || recorded(bag, topic) >= before + more);
}

/// Number that `custom_data` of a bag's metadata has under a key.
pub fn custom_number(bag: &Path, key: &str) -> u64 {
    let text = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
    let line = text
        .lines()
        .find(|line| line.trim_start_matches([' ', '"', '\'']).starts_with(key))
        .unwrap_or_else(|| panic!("{key}: {text}"));
    line.rsplit(['\'', '"']).nth(1).unwrap().parse().unwrap()
}
