//! Texts of the message definitions, as used by bags and tools.

use crate::field;

/// Separator of the definitions in a schema: exactly 80 `=`. Other lengths make `mcap-ros2-support` fail.
pub const SEPARATOR: &str = "================================================================================";

/// All known definitions: name as `package/Type`, text of the `.msg` file. Definitions of other packages are for
/// recordings of their topics, with the fields and constants of ROS 2 Jazzy.
const TEXTS: [(&str, &str); 46] = [
    ("excavator_msgs/ArmState", include_str!("../msg/ArmState.msg")),
    ("excavator_msgs/CylinderEnergy", include_str!("../msg/CylinderEnergy.msg")),
    ("excavator_msgs/CylinderState", include_str!("../msg/CylinderState.msg")),
    ("excavator_msgs/EnergyState", include_str!("../msg/EnergyState.msg")),
    ("excavator_msgs/EnergyTerm", include_str!("../msg/EnergyTerm.msg")),
    ("excavator_msgs/OrificeCommand", include_str!("../msg/OrificeCommand.msg")),
    ("builtin_interfaces/Duration", include_str!("../common_interfaces/builtin_interfaces/Duration.msg")),
    ("builtin_interfaces/Time", include_str!("../common_interfaces/builtin_interfaces/Time.msg")),
    ("com3_msgs/FluidPressureArray", include_str!("../common_interfaces/com3_msgs/FluidPressureArray.msg")),
    ("diagnostic_msgs/DiagnosticArray", include_str!("../common_interfaces/diagnostic_msgs/DiagnosticArray.msg")),
    ("diagnostic_msgs/DiagnosticStatus", include_str!("../common_interfaces/diagnostic_msgs/DiagnosticStatus.msg")),
    ("diagnostic_msgs/KeyValue", include_str!("../common_interfaces/diagnostic_msgs/KeyValue.msg")),
    ("geometry_msgs/Point", include_str!("../common_interfaces/geometry_msgs/Point.msg")),
    ("geometry_msgs/Pose", include_str!("../common_interfaces/geometry_msgs/Pose.msg")),
    ("geometry_msgs/PoseStamped", include_str!("../common_interfaces/geometry_msgs/PoseStamped.msg")),
    ("geometry_msgs/Quaternion", include_str!("../common_interfaces/geometry_msgs/Quaternion.msg")),
    ("geometry_msgs/Transform", include_str!("../common_interfaces/geometry_msgs/Transform.msg")),
    ("geometry_msgs/TransformStamped", include_str!("../common_interfaces/geometry_msgs/TransformStamped.msg")),
    ("geometry_msgs/Twist", include_str!("../common_interfaces/geometry_msgs/Twist.msg")),
    ("geometry_msgs/TwistStamped", include_str!("../common_interfaces/geometry_msgs/TwistStamped.msg")),
    ("geometry_msgs/Vector3", include_str!("../common_interfaces/geometry_msgs/Vector3.msg")),
    ("geometry_msgs/Wrench", include_str!("../common_interfaces/geometry_msgs/Wrench.msg")),
    ("geometry_msgs/WrenchStamped", include_str!("../common_interfaces/geometry_msgs/WrenchStamped.msg")),
    ("rcl_interfaces/Log", include_str!("../common_interfaces/rcl_interfaces/Log.msg")),
    ("rcl_interfaces/Parameter", include_str!("../common_interfaces/rcl_interfaces/Parameter.msg")),
    ("rcl_interfaces/ParameterEvent", include_str!("../common_interfaces/rcl_interfaces/ParameterEvent.msg")),
    ("rcl_interfaces/ParameterValue", include_str!("../common_interfaces/rcl_interfaces/ParameterValue.msg")),
    ("rosgraph_msgs/Clock", include_str!("../common_interfaces/rosgraph_msgs/Clock.msg")),
    ("sensor_msgs/FluidPressure", include_str!("../common_interfaces/sensor_msgs/FluidPressure.msg")),
    ("sensor_msgs/Imu", include_str!("../common_interfaces/sensor_msgs/Imu.msg")),
    ("sensor_msgs/JointState", include_str!("../common_interfaces/sensor_msgs/JointState.msg")),
    ("sensor_msgs/Joy", include_str!("../common_interfaces/sensor_msgs/Joy.msg")),
    ("sensor_msgs/Temperature", include_str!("../common_interfaces/sensor_msgs/Temperature.msg")),
    ("std_msgs/Bool", include_str!("../common_interfaces/std_msgs/Bool.msg")),
    ("std_msgs/Float32", include_str!("../common_interfaces/std_msgs/Float32.msg")),
    ("std_msgs/Float64", include_str!("../common_interfaces/std_msgs/Float64.msg")),
    ("std_msgs/Float64MultiArray", include_str!("../common_interfaces/std_msgs/Float64MultiArray.msg")),
    ("std_msgs/Header", include_str!("../common_interfaces/std_msgs/Header.msg")),
    ("std_msgs/Int32", include_str!("../common_interfaces/std_msgs/Int32.msg")),
    ("std_msgs/Int64", include_str!("../common_interfaces/std_msgs/Int64.msg")),
    ("std_msgs/MultiArrayDimension", include_str!("../common_interfaces/std_msgs/MultiArrayDimension.msg")),
    ("std_msgs/MultiArrayLayout", include_str!("../common_interfaces/std_msgs/MultiArrayLayout.msg")),
    ("std_msgs/String", include_str!("../common_interfaces/std_msgs/String.msg")),
    ("std_msgs/UInt32", include_str!("../common_interfaces/std_msgs/UInt32.msg")),
    ("std_msgs/UInt8", include_str!("../common_interfaces/std_msgs/UInt8.msg")),
    ("tf2_msgs/TFMessage", include_str!("../common_interfaces/tf2_msgs/TFMessage.msg")),
];

/// Text of the `.msg` file of a type, `None` for an unknown type.
///
/// The name may be `package/msg/Type` or `package/Type`.
pub fn message_text(type_name: &str) -> Option<&'static str> {
    let wanted = field::short_name(type_name);
    TEXTS.iter().find(|(name, _)| *name == wanted).map(|(_, text)| *text)
}

/// The `ros2msg` schema of a type: its definition followed by those of all types that it contains. Each appears once,
/// headed by [`SEPARATOR`] and `MSG: package/Type`. `None` for an unknown type.
///
/// ```
/// let schema = excavator_msgs::definitions::schema("excavator_msgs/msg/OrificeCommand");
/// assert!(schema.is_some_and(|text| text.contains("MSG: builtin_interfaces/Time\n")));
/// ```
pub fn schema(type_name: &str) -> Option<String> {
    let types = with_contained(type_name)?;
    let (root, contained) = types.split_first()?;
    let mut text = message_text(root)?.to_string();
    for name in contained {
        text.push_str(&format!("\n{SEPARATOR}\nMSG: {name}\n{}", message_text(name)?));
    }
    Some(text)
}

/// `package/Type` of a type and of all types that it contains, each once, in order of first use. `None` if one of them
/// is unknown.
pub(crate) fn with_contained(type_name: &str) -> Option<Vec<String>> {
    let mut types = vec![field::short_name(type_name)];
    let mut next = 0;
    while let Some(name) = types.get(next) {
        let package = field::package(name).to_string();
        for field in field::fields(message_text(name)?).iter().filter(|field| !field.is_primitive()) {
            let contained = field::resolve(field.base_type(), &package);
            if !types.contains(&contained) {
                types.push(contained);
            }
        }
        next += 1;
    }
    Some(types)
}

#[cfg(test)]
#[allow(clippy::panic)]
mod tests {
    use super::*;

    #[test]
    fn the_separator_is_80_characters_long() {
        assert_eq!(SEPARATOR.len(), 80);
        assert!(SEPARATOR.bytes().all(|byte| byte == b'='));
    }

    #[test]
    fn a_schema_contains_every_type_once() {
        let Some(schema) = schema("excavator_msgs/msg/EnergyState") else { panic!("no schema") };
        let headings: Vec<&str> = schema.lines().filter(|line| line.starts_with("MSG: ")).collect();
        assert_eq!(
            headings,
            [
                "MSG: std_msgs/Header",
                "MSG: excavator_msgs/CylinderEnergy",
                "MSG: builtin_interfaces/Time",
                "MSG: excavator_msgs/EnergyTerm"
            ]
        );
        assert_eq!(schema.lines().filter(|line| *line == SEPARATOR).count(), 4);
    }

    #[test]
    fn every_type_has_a_schema_and_strangers_have_none() {
        for (name, _) in TEXTS {
            assert!(schema(name).is_some(), "{name}");
        }
        assert_eq!(schema("sensor_msgs/msg/PointCloud2"), None);
        assert_eq!(schema(""), None);
    }
}
