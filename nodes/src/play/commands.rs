//! Topics that move or stop a machine.

use std::collections::BTreeSet;

/// Whether messages of the topic are commands to a machine: openings of valves, and the emergency stop. A live machine on
/// the same graph would obey a recording of them.
pub(super) fn is_command(name: &str, type_name: &str) -> bool {
    let last = |text: &'static str| move |whole: &str| whole.rsplit('/').next() == Some(text);
    last("OrificeCommand")(type_name)
        || last("orifice_command")(name)
        || (last("stop")(name) && last("Bool")(type_name))
}

/// The line about topics that are not played.
pub(super) fn left_out_line(topics: &BTreeSet<String>) -> String {
    let names: Vec<&str> = topics.iter().map(String::as_str).collect();
    let names = names.join(" ");
    format!(
        "commands are not played, a live machine would follow them: {names}; to play them, name every topic that is \
             played with --topics, {names} among them"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

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
