//! Topics that move or stop a machine.

use std::collections::BTreeSet;

use excavator_msgs::Time;
use rustdds::bytes::Bytes;

/// Whether messages of the topic command a machine: valve openings and the emergency stop. A live machine on the same graph
/// would obey recorded commands.
pub(super) fn is_command(name: &str, type_name: &str) -> bool {
    let last = |text: &'static str| move |whole: &str| whole.rsplit('/').next() == Some(text);
    last("OrificeCommand")(type_name)
        || last("orifice_command")(name)
        || (last("stop")(name) && last("Bool")(type_name))
}

/// Sets the stamp of an `OrificeCommand` (CDR, little endian, with encapsulation) to the current time. A user who names the
/// topic wants its commands followed, and a machine rejects commands as old as the recording. Other messages stay unchanged.
pub(super) fn stamped_now(data: Bytes, type_name: &str, now: Time) -> Bytes {
    let is_command = type_name.rsplit('/').next() == Some("OrificeCommand");
    if !is_command || data.len() < STAMP.end || !data.starts_with(&[0, 1]) {
        return data;
    }
    let mut bytes = data.to_vec();
    bytes[STAMP][..4].copy_from_slice(&now.sec.to_le_bytes());
    bytes[STAMP][4..].copy_from_slice(&now.nanosec.to_le_bytes());
    bytes.into()
}

/// Bytes of the stamp: the header comes first, after four bytes of encapsulation.
const STAMP: std::ops::Range<usize> = 4..12;

/// The log line about topics that are not played.
pub(super) fn left_out_line(topics: &BTreeSet<String>) -> String {
    let names: Vec<&str> = topics.iter().map(String::as_str).collect();
    let names = names.join(" ");
    format!(
        "commands are not played, a live machine would follow them: {names}; to play them, name every topic that is \
             played with --topics, {names} among them"
    )
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_msgs::OrificeCommand;
    use rosbag2::cdr;

    #[test]
    fn commands_are_stamped_anew_and_nothing_else_is() {
        let now = Time { sec: 1_800_000_000, nanosec: 5 };
        let old = OrificeCommand { header: Default::default(), names: vec!["arm".into()], areas: vec![2e-5] };
        let data = Bytes::from(cdr::encode(&old).unwrap());
        let stamped: OrificeCommand =
            cdr::decode(&stamped_now(data.clone(), "excavator_msgs/msg/OrificeCommand", now)).unwrap();
        assert_eq!(stamped.header.stamp, now);
        assert_eq!((stamped.names, stamped.areas), (old.names, old.areas));
        assert_eq!(stamped_now(data.clone(), "excavator_msgs/msg/ArmState", now), data);
        let short = data.slice(..8);
        assert_eq!(stamped_now(short.clone(), "excavator_msgs/msg/OrificeCommand", now), short);
    }

    #[test]
    fn commands_are_known_by_type_and_by_name() {
        assert!(is_command("/left/valve", "excavator_msgs/msg/OrificeCommand"));
        assert!(is_command("/pit/arm/orifice_command", "other_msgs/msg/Command"));
        assert!(is_command("orifice_command", ""));
        assert!(is_command("/arm/stop", "std_msgs/msg/Bool"));
        assert!(!is_command("/arm/state", "excavator_msgs/msg/ArmState"));
        assert!(!is_command("/bus/stop", "std_msgs/msg/String"));
        assert!(!is_command("/not_orifice_command", "std_msgs/msg/String"));
    }
}
