//! The texts of the message definitions, as bags and tools carry them.

use crate::layout;

/// What separates the definitions of a schema: exactly 80 `=`. Other lengths make `mcap-ros2-support` fail.
pub const SEPARATOR: &str = "================================================================================";

/// Every definition that this package uses: name as `package/Type`, text of the `.msg` file.
const TEXTS: [(&str, &str); 8] = [
    ("excavator_msgs/ArmState", include_str!("../msg/ArmState.msg")),
    ("excavator_msgs/CylinderEnergy", include_str!("../msg/CylinderEnergy.msg")),
    ("excavator_msgs/CylinderState", include_str!("../msg/CylinderState.msg")),
    ("excavator_msgs/EnergyState", include_str!("../msg/EnergyState.msg")),
    ("excavator_msgs/EnergyTerm", include_str!("../msg/EnergyTerm.msg")),
    ("excavator_msgs/OrificeCommand", include_str!("../msg/OrificeCommand.msg")),
    ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"),
    ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"),
];

/// Text of the `.msg` file of one type, `None` for a type that this package does not use.
///
/// The name may be written `package/msg/Type` or `package/Type`.
pub fn message_text(type_name: &str) -> Option<&'static str> {
    let wanted = layout::short_name(type_name);
    TEXTS.iter().find(|(name, _)| *name == wanted).map(|(_, text)| *text)
}

/// The `ros2msg` schema of a type: its definition followed by those of all types that it contains, each once and
/// headed by [`SEPARATOR`] and `MSG: package/Type`. `None` for a type that this package does not use.
///
/// ```
/// let schema = excavator_msgs::definitions::schema("excavator_msgs/msg/OrificeCommand");
/// assert!(schema.is_some_and(|text| text.contains("MSG: builtin_interfaces/Time\n")));
/// ```
pub fn schema(type_name: &str) -> Option<String> {
    let root = layout::short_name(type_name);
    let mut text = message_text(&root)?.to_string();
    let mut included = vec![root];
    let mut next = 0;
    while next < included.len() {
        let package = layout::package(&included[next]).to_string();
        for field in layout::fields(message_text(&included[next])?) {
            if field.is_primitive() {
                continue;
            }
            let dependency = layout::resolve(field.base_type(), &package);
            if !included.contains(&dependency) {
                text.push_str(&format!("\n{SEPARATOR}\nMSG: {dependency}\n{}", message_text(&dependency)?));
                included.push(dependency);
            }
        }
        next += 1;
    }
    Some(text)
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
        assert_eq!(schema("sensor_msgs/msg/JointState"), None);
        assert_eq!(schema(""), None);
    }
}
