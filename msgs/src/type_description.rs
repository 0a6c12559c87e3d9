//! Type descriptions that tools request from a node (REP 2011), and their hashes (REP 2016).

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::definitions::{message_text, with_contained};
use crate::field::{self, Field};

/// `type_description_interfaces/msg/TypeDescription`.
///
/// ```
/// use excavator_msgs::TypeDescription;
///
/// let hash = TypeDescription::of("std_msgs/msg/String").map(|described| described.hash());
/// assert_eq!(hash.as_deref(), Some("RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"));
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TypeDescription {
    /// The type itself.
    pub type_description: IndividualTypeDescription,
    /// Types that it contains, each once, by name.
    pub referenced_type_descriptions: Vec<IndividualTypeDescription>,
}

/// `type_description_interfaces/msg/IndividualTypeDescription`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct IndividualTypeDescription {
    /// `package/msg/Type`.
    pub type_name: String,
    /// Its fields in order.
    pub fields: Vec<FieldDescription>,
}

/// `type_description_interfaces/msg/Field`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FieldDescription {
    /// Name.
    pub name: String,
    /// Type.
    pub field_type: FieldType,
    /// Default value as the definition has it.
    pub default_value: String,
}

/// `type_description_interfaces/msg/FieldType`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FieldType {
    /// A constant of that message: 1 is a nested type, 11 a `float64`; 48 more an array, 96 a bounded, 144 an unbounded sequence.
    pub type_id: u8,
    /// Length of an array, largest length of a bounded sequence.
    pub capacity: u64,
    /// Largest length of a bounded string.
    pub string_capacity: u64,
    /// `package/msg/Type` of a nested type.
    pub nested_type_name: String,
}

const NESTED: u8 = 1;
const BOUNDED: u8 = 4;
const ARRAY: u8 = 48;
const BOUNDED_SEQUENCE: u8 = 96;
const SEQUENCE: u8 = 144;

impl TypeDescription {
    /// For a known type, written `package/msg/Type`; `None` for any other.
    pub fn of(type_name: &str) -> Option<TypeDescription> {
        let mut described = with_contained(type_name)?.into_iter().map(|name| individual(&name));
        let type_description = described.next()??;
        let mut referenced_type_descriptions = described.collect::<Option<Vec<_>>>()?;
        referenced_type_descriptions.sort_by(|a, b| a.type_name.cmp(&b.type_name));
        Some(TypeDescription { type_description, referenced_type_descriptions })
    }

    /// The hash of the type: `RIHS01_` and the SHA-256 of its fields as JSON, without default values.
    pub fn hash(&self) -> String {
        let referenced: Vec<String> = self.referenced_type_descriptions.iter().map(json).collect();
        let text = format!(
            "{{\"type_description\": {}, \"referenced_type_descriptions\": [{}]}}",
            json(&self.type_description),
            referenced.join(", ")
        );
        let digest: String = Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect();
        format!("RIHS01_{digest}")
    }

    /// The names of the type and of the types that it contains.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&self.type_description)
            .chain(&self.referenced_type_descriptions)
            .map(|one| one.type_name.as_str())
    }
}

/// Names are letters, digits, `_` and `/`, so nothing needs escaping.
fn json(description: &IndividualTypeDescription) -> String {
    let field = |field: &FieldDescription| {
        let FieldType { type_id, capacity, string_capacity, nested_type_name } = &field.field_type;
        format!(
            "{{\"name\": \"{}\", \"type\": {{\"type_id\": {type_id}, \"capacity\": {capacity}, \"string_capacity\": \
             {string_capacity}, \"nested_type_name\": \"{nested_type_name}\"}}}}",
            field.name
        )
    };
    let fields: Vec<String> = description.fields.iter().map(field).collect();
    format!("{{\"type_name\": \"{}\", \"fields\": [{}]}}", description.type_name, fields.join(", "))
}

fn individual(short_name: &str) -> Option<IndividualTypeDescription> {
    let text = message_text(short_name)?;
    let package = field::package(short_name);
    let fields = field::fields(text)
        .into_iter()
        .map(|field| {
            Some(FieldDescription {
                field_type: field_type(&field, package)?,
                default_value: default_value(text, &field.name),
                name: field.name,
            })
        })
        .collect::<Option<Vec<_>>>()?;
    Some(IndividualTypeDescription { type_name: long_name(short_name), fields })
}

fn long_name(short_name: &str) -> String {
    short_name.replacen('/', "/msg/", 1)
}

fn field_type(field: &Field, package: &str) -> Option<FieldType> {
    let string_capacity = field.type_name.split('[').next()?.split_once("<=").map(|(_, length)| length.parse::<u64>());
    let string_capacity = string_capacity.transpose().ok()?;
    let (base, nested_type_name) = if field.is_primitive() {
        let bounded = if string_capacity.is_some() { BOUNDED } else { 0 };
        (primitive(field.base_type())? + bounded, String::new())
    } else {
        (NESTED, long_name(&field::resolve(field.base_type(), package)))
    };
    let inside = field.array_suffix().trim_start_matches('[').trim_end_matches(']');
    let (shape, capacity) = match (field.array_suffix(), inside.strip_prefix("<=")) {
        ("", _) => (0, 0),
        ("[]", _) => (SEQUENCE, 0),
        (_, Some(most)) => (BOUNDED_SEQUENCE, most.parse().ok()?),
        (_, None) => (ARRAY, inside.parse().ok()?),
    };
    Some(FieldType { type_id: base + shape, capacity, string_capacity: string_capacity.unwrap_or(0), nested_type_name })
}

/// `char` of a `.msg` file is a `uint8`.
fn primitive(name: &str) -> Option<u8> {
    Some(match name {
        "int8" => 2,
        "uint8" | "char" => 3,
        "int16" => 4,
        "uint16" => 5,
        "int32" => 6,
        "uint32" => 7,
        "int64" => 8,
        "uint64" => 9,
        "float32" => 10,
        "float64" => 11,
        "bool" => 15,
        "byte" => 16,
        "string" => 17,
        "wstring" => 18,
        _ => return None,
    })
}

/// The text after the name of a field in its line; empty without a default value.
fn default_value(text: &str, name: &str) -> String {
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default().trim());
    let of_field = lines.filter_map(|line| line.split_once(char::is_whitespace)?.1.trim_start().strip_prefix(name));
    let mut values = of_field.filter(|rest| rest.is_empty() || rest.starts_with(char::is_whitespace));
    values.next().unwrap_or_default().trim().to_string()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// As in rosidl_generator_type_description of ROS 2 Jazzy.
    #[test]
    fn hashes_are_those_of_ros() {
        for (name, hash) in [
            ("std_msgs/msg/String", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"),
            ("excavator_msgs/msg/ArmState", "36d7ead3d597df504c2cf48188fa34993ffbb934b74a6f9f4ae5f2296e9c42ec"),
            ("excavator_msgs/msg/EnergyState", "d5a3c933f9d516e72554335483f9ecaff44d708c71e5fc2c5a043595b28c46d2"),
            ("excavator_msgs/msg/OrificeCommand", "3130a8fab5501f46fbb095e4833e829422b1b54c658a69148ad221f8f44bac30"),
            ("diagnostic_msgs/msg/DiagnosticArray", "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"),
            ("geometry_msgs/msg/PoseStamped", "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"),
            ("rcl_interfaces/msg/Log", "e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac"),
            ("rcl_interfaces/msg/ParameterEvent", "043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204"),
            ("rosgraph_msgs/msg/Clock", "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564"),
            ("sensor_msgs/msg/JointState", "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"),
        ] {
            assert_eq!(TypeDescription::of(name).unwrap().hash(), format!("RIHS01_{hash}"), "{name}");
        }
    }

    #[test]
    fn defaults_sequences_and_nested_types_are_described() {
        let pose = TypeDescription::of("geometry_msgs/msg/PoseStamped").unwrap();
        let quaternion = pose.referenced_type_descriptions.iter().find(|one| one.type_name.ends_with("Quaternion"));
        let w = quaternion.unwrap().fields.last().unwrap();
        assert_eq!((w.name.as_str(), w.default_value.as_str(), w.field_type.type_id), ("w", "1", 11));
        let state = TypeDescription::of("excavator_msgs/ArmState").unwrap();
        let cylinders = state.type_description.fields.iter().find(|field| field.name == "cylinders").unwrap();
        assert_eq!(cylinders.field_type.type_id, NESTED + SEQUENCE);
        assert_eq!(cylinders.field_type.nested_type_name, "excavator_msgs/msg/CylinderState");
        assert_eq!(TypeDescription::of("excavator_msgs/msg/Nothing"), None);
    }
}
