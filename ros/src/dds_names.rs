//! Mapping of ROS 2 names to DDS (design article "Topic and Service name mapping to DDS").

/// DDS topic of a ROS topic: `/arm/state` is `rt/arm/state`.
pub fn dds_topic(full_name: &str) -> String {
    format!("rt{full_name}")
}

/// ROS topic of a DDS topic; `None` for services, parts of actions and topics that are not from ROS.
pub fn ros_topic(dds_topic: &str) -> Option<&str> {
    dds_topic.strip_prefix("rt").filter(|name| name.starts_with('/'))
}

/// DDS type of a ROS type: `std_msgs/msg/String` is `std_msgs::msg::dds_::String_`.
pub fn dds_type(ros_type: &str) -> String {
    let (package, name) = ros_type.rsplit_once('/').unwrap_or(("", ros_type));
    format!("{}::dds_::{name}_", package.replace('/', "::"))
}

/// ROS type of a DDS type; `None` for types that are not from ROS.
pub fn ros_type(dds_type: &str) -> Option<String> {
    let (package, name) = dds_type.rsplit_once("::dds_::")?;
    Some(format!("{}/{}", package.replace("::", "/"), name.strip_suffix('_')?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_survive_the_round_trip() {
        assert_eq!(dds_type("std_msgs/msg/String"), "std_msgs::msg::dds_::String_");
        for name in ["excavator_msgs/msg/ArmState", "sensor_msgs/msg/JointState"] {
            assert_eq!(ros_type(&dds_type(name)).as_deref(), Some(name));
        }
        assert_eq!(ros_topic(&dds_topic("/arm/state")), Some("/arm/state"));
    }

    #[test]
    fn what_is_not_of_ros_has_no_name_there() {
        assert_eq!(ros_topic("rq/arm_simulator/get_parametersRequest"), None);
        assert_eq!(ros_topic("ros_discovery_info"), None);
        assert_eq!(ros_topic("rtx"), None);
        assert_eq!(ros_type("ShapeType"), None);
    }
}
