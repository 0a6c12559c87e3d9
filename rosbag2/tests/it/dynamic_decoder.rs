//! Fields of any message by the definition in the bag: equal to the typed decoder, in both languages, and without panic
//! on anything.

use proptest::prelude::*;
use rosbag2::dynamic::{Definitions, FieldPath, Layout, LayoutError, PathError, Selector, numeric_leaves};
use rosbag2::{Topic, cdr};
use serde::Serialize;

/// `std_msgs/Header`.
#[derive(Serialize)]
struct Header {
    stamp: (i32, u32),
    frame_id: String,
}

fn header() -> Header {
    Header { stamp: (5, 7), frame_id: "odd".to_string() }
}

fn topic(type_name: &str, encoding: &str, schema: &str) -> Topic {
    Topic {
        name: "/topic".to_string(),
        type_name: type_name.to_string(),
        schema_encoding: encoding.to_string(),
        schema: schema.to_string(),
        message_encoding: "cdr".to_string(),
        offered_qos_profiles: String::new(),
    }
}

fn layout(type_name: &str, encoding: &str, schema: &str) -> Layout {
    Layout::of_topic(&topic(type_name, encoding, schema), &Definitions::default()).unwrap()
}

fn number(layout: &Layout, path: &str, message: &[u8]) -> Option<f64> {
    Selector::number(layout, &path.parse().unwrap()).unwrap().read(layout, message).unwrap()
}

#[derive(Serialize)]
struct JointState {
    header: Header,
    name: Vec<String>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
}

#[test]
fn a_joint_is_found_by_the_list_of_names_without_any_definition_in_the_bag() {
    let layout = layout("sensor_msgs/msg/JointState", "", "");
    let names = ["left", "arm"].map(String::from).to_vec();
    let message =
        JointState { header: header(), name: names, position: vec![0.5, 0.25], velocity: vec![], effort: vec![7.0] };
    let bytes = cdr::encode(&message).unwrap();
    layout.check(&bytes).unwrap();
    assert_eq!(number(&layout, "position[name=arm]", &bytes), Some(0.25));
    assert_eq!(number(&layout, "velocity[name=arm]", &bytes), None);
    assert_eq!(number(&layout, "effort[name=left]", &bytes), Some(7.0));
    assert_eq!(number(&layout, "effort[name=arm]", &bytes), None);
    let leaves: Vec<String> = numeric_leaves(&layout, &bytes).unwrap().iter().map(ToString::to_string).collect();
    assert!(leaves.contains(&"position[name=arm]".to_string()), "{leaves:?}");
}

const IDL: &str = r#"================================================================================
IDL: valve_msgs/msg/Spool
// generated
#include "std_msgs/msg/Header.idl"
module valve_msgs {
  module msg {
    typedef double double__3[3];
    module Spool_Constants {
      @verbatim (language="comment", text="a \"limit\" (of the spool)")
      const double LIMIT = 4.0e-4;
    };
    @verbatim (language="comment", text="Spool of a valve")
    struct Spool {
      std_msgs::msg::Header header;
      @default (value=TRUE)
      boolean enabled;
      @unit(value="m2")
      double__3 areas;
      unsigned short raw; /* counts */
      sequence<valve_msgs::msg::Port, 4> ports;
      long long ticks;
      string<8> side;
      float current;
    };
  };
};
================================================================================
IDL: valve_msgs/msg/Port
module valve_msgs { module msg { struct Port { string id; octet flags; double pressure; }; }; };
================================================================================
IDL: std_msgs/msg/Header
module std_msgs { module msg { struct Header { builtin_interfaces::msg::Time stamp; string frame_id; }; }; };
"#;
const MSG: &str = "std_msgs/Header header\nfloat64 LIMIT=4.0e-4\nbool enabled true\nfloat64[3] areas # m2\nuint16 raw\n\
                   Port[<=4] ports\nint64 ticks\nstring<=8 side\nfloat32 current\n\
                   ================================================================================\n\
                   MSG: valve_msgs/Port\nstring id\nbyte flags\nfloat64 pressure\n";

#[derive(Serialize)]
struct Port {
    id: String,
    flags: u8,
    pressure: f64,
}

#[derive(Serialize)]
struct Spool {
    header: Header,
    enabled: bool,
    areas: [f64; 3],
    raw: u16,
    ports: Vec<Port>,
    ticks: i64,
    side: String,
    current: f32,
}

#[test]
fn both_languages_give_the_same_layout() {
    let port = |id: &str, pressure: f64| Port { id: id.to_string(), flags: 3, pressure };
    let message = Spool {
        header: header(),
        enabled: true,
        areas: [1.0, 2.0, 3.0],
        raw: 65_535,
        ports: vec![port("A", 1e5), port("B", 2e5)],
        ticks: -5,
        side: "left".to_string(),
        current: 0.5,
    };
    let bytes = cdr::encode(&message).unwrap();
    let (idl, msg) = (layout("valve_msgs/msg/Spool", "ros2idl", IDL), layout("valve_msgs/msg/Spool", "ros2msg", MSG));
    assert_eq!(idl, msg);
    idl.check(&bytes).unwrap();
    for (path, expected) in [
        ("enabled", 1.0),
        ("areas[2]", 3.0),
        ("raw", 65_535.0),
        ("ports[id=B].pressure", 2e5),
        ("ports[0].flags", 3.0),
        ("ticks", -5.0),
        ("current", 0.5),
    ] {
        assert_eq!(number(&idl, path, &bytes), Some(expected), "{path}");
    }
}

#[test]
fn wrong_paths_say_what_would_be_right() {
    let layout = layout("valve_msgs/msg/Spool", "ros2idl", IDL);
    let error = |path: &str| Selector::number(&layout, &path.parse().unwrap()).unwrap_err();
    let text = error("port[0].pressure").to_string();
    assert!(text.contains("has no field \"port\"") && text.contains("ports"), "{text}");
    assert!(matches!(error("areas"), PathError::NeedsIndex { .. }));
    assert!(matches!(error("raw[1]"), PathError::NotAnArray { .. }));
    assert!(matches!(error("ports[name=A].pressure"), PathError::NoKey { .. }));
    assert!(matches!(error("side"), PathError::NotANumber { .. }));
    assert!(matches!(error("raw.x"), PathError::NoField { .. }));
    for path in ["", ".", "a..b", "a[", "a]", "a[x]", "a[=b]", "a[1]b", "a b"] {
        assert!(path.parse::<FieldPath>().is_err(), "{path}");
    }
    let unknown = topic("nobody_msgs/msg/Thing", "", "");
    let error = Layout::of_topic(&unknown, &Definitions::default()).unwrap_err();
    assert!(error.to_string().contains("definitions"), "{error}");
    let endless = topic("p/msg/A", "ros2msg", "A[] a");
    assert!(matches!(Layout::of_topic(&endless, &Definitions::default()), Err(LayoutError::TooDeep { .. })));
    let wide = (0..40).fold(String::from("B0 x\n"), |text, level| {
        text + &format!("{}\nMSG: p/B{level}\nB{n} a\nB{n} b\n", "=".repeat(80), n = level + 1)
    });
    assert!(Layout::of_topic(&topic("p/msg/A", "ros2msg", &wide), &Definitions::default()).is_err());
}

/// A random type as its definition, one message of it as bytes, and the numbers in it in order.
#[derive(Debug, Clone)]
enum Field {
    Number(usize, Vec<u64>, Option<bool>),
    Text(String),
    Inner(Vec<Field>, usize),
}

const NUMBERS: [(&str, usize); 10] = [
    ("uint8", 1),
    ("int8", 1),
    ("uint16", 2),
    ("int16", 2),
    ("uint32", 4),
    ("int32", 4),
    ("uint64", 8),
    ("int64", 8),
    ("float32", 4),
    ("float64", 8),
];

fn fields() -> impl Strategy<Value = Vec<Field>> {
    let leaf = prop_oneof![
        (0..NUMBERS.len(), prop::collection::vec(any::<u64>(), 1..5), prop::option::of(any::<bool>()))
            .prop_map(|(kind, values, array)| Field::Number(kind, values, array)),
        "[a-zäö]{0,9}".prop_map(Field::Text),
    ];
    let nested = leaf.prop_recursive(3, 30, 5, |inner| {
        (prop::collection::vec(inner, 1..5), 0..3_usize).prop_map(|(fields, count)| Field::Inner(fields, count))
    });
    prop::collection::vec(nested, 1..6)
}

/// Definition texts and message, written independently of the decoder.
#[derive(Default)]
struct Sample {
    sections: Vec<String>,
    bytes: Vec<u8>,
    numbers: Vec<(String, f64)>,
}

impl Sample {
    fn align(&mut self, size: usize) {
        while !self.bytes.len().is_multiple_of(size) {
            self.bytes.push(0xaa);
        }
    }

    fn length(&mut self, length: usize) {
        self.align(4);
        self.bytes.extend((length as u32).to_le_bytes());
    }

    fn define(&mut self, fields: &[Field]) -> usize {
        let number = self.sections.len();
        self.sections.push(String::new());
        let mut text = String::new();
        for (index, field) in fields.iter().enumerate() {
            match field {
                Field::Number(kind, values, None) => {
                    let _ = values;
                    text += &format!("{} f{index}\n", NUMBERS[*kind].0);
                }
                Field::Number(kind, _, Some(true)) => text += &format!("{}[] f{index}\n", NUMBERS[*kind].0),
                Field::Number(kind, values, Some(false)) => {
                    text += &format!("{}[{}] f{index}\n", NUMBERS[*kind].0, values.len());
                }
                Field::Text(_) => text += &format!("string f{index}\n"),
                Field::Inner(inner, _) => text += &format!("T{}[] f{index}\n", self.define(inner)),
            }
        }
        self.sections[number] = text;
        number
    }

    fn write(&mut self, fields: &[Field], prefix: &str) {
        for (index, field) in fields.iter().enumerate() {
            let name = format!("{prefix}f{index}");
            match field {
                Field::Number(kind, values, array) => {
                    let values = if array.is_none() { &values[..1] } else { values };
                    if *array == Some(true) {
                        self.length(values.len());
                    }
                    for (place, value) in values.iter().enumerate() {
                        let path = if array.is_none() { name.clone() } else { format!("{name}[{place}]") };
                        let number = self.number(*kind, *value);
                        self.numbers.push((path, number));
                    }
                }
                Field::Text(text) => {
                    self.length(text.len() + 1);
                    self.bytes.extend(text.as_bytes());
                    self.bytes.push(0);
                }
                Field::Inner(inner, count) => {
                    self.length(*count);
                    (0..*count).for_each(|place| self.write(inner, &format!("{name}[{place}].")));
                }
            }
        }
    }

    fn number(&mut self, kind: usize, value: u64) -> f64 {
        let (name, size) = NUMBERS[kind];
        self.align(size);
        self.bytes.extend(&value.to_le_bytes()[..size]);
        match name {
            "uint8" => f64::from(value as u8),
            "int8" => f64::from(value as i8),
            "uint16" => f64::from(value as u16),
            "int16" => f64::from(value as i16),
            "uint32" => f64::from(value as u32),
            "int32" => f64::from(value as i32),
            "uint64" => value as f64,
            "int64" => value as i64 as f64,
            "float32" => f64::from(f32::from_bits(value as u32)),
            _ => f64::from_bits(value),
        }
    }

    fn of(fields: &[Field]) -> (String, Vec<u8>, Vec<(String, f64)>) {
        let mut sample = Sample::default();
        sample.define(fields);
        sample.write(fields, "");
        let mut schema = sample.sections[0].clone();
        for (number, section) in sample.sections.iter().enumerate().skip(1) {
            schema += &format!("{}\nMSG: p/T{number}\n{section}", "=".repeat(80));
        }
        (schema, [&[0, 1, 0, 0][..], &sample.bytes].concat(), sample.numbers)
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn every_number_of_a_random_type_is_found(fields in fields()) {
        let (schema, bytes, numbers) = Sample::of(&fields);
        let layout = layout("p/msg/Root", "ros2msg", &schema);
        layout.check(&bytes).unwrap();
        for (path, expected) in &numbers {
            let found = number(&layout, path, &bytes).unwrap();
            prop_assert!(found == *expected || (found.is_nan() && expected.is_nan()), "{}: {} {}", path, found, expected);
        }
        let leaves: Vec<String> = numeric_leaves(&layout, &bytes).unwrap().iter().map(ToString::to_string).collect();
        prop_assert_eq!(leaves, numbers.iter().map(|(path, _)| path.clone()).collect::<Vec<_>>());
        // Every shorter message is an error or gives what it still holds, and nothing panics.
        for length in 0..bytes.len() {
            let _ = layout.check(&bytes[..length]);
            for (path, _) in numbers.iter().take(3) {
                let _ = Selector::number(&layout, &path.parse().unwrap()).unwrap().read(&layout, &bytes[..length]);
            }
        }
    }

    #[test]
    fn random_bytes_never_panic(fields in fields(), noise in prop::collection::vec(any::<u8>(), 0..200)) {
        let (schema, _, numbers) = Sample::of(&fields);
        let layout = layout("p/msg/Root", "ros2msg", &schema);
        for encapsulation in [[0, 0, 0, 0], [0, 1, 0, 0], [0, 7, 0, 0]] {
            let bytes = [&encapsulation[..], &noise].concat();
            let _ = layout.check(&bytes);
            let _ = numeric_leaves(&layout, &bytes);
            for (path, _) in numbers.iter().take(5) {
                let _ = Selector::number(&layout, &path.parse().unwrap()).unwrap().read(&layout, &bytes);
            }
        }
    }

    #[test]
    fn random_definitions_never_panic(noise in "[a-z0-9_\\[\\]<>=:;{}@()\"'#/ \n.,]{0,120}", cut in 0..IDL.len()) {
        for encoding in ["ros2msg", "ros2idl"] {
            let _ = Definitions::from_schema("p/msg/T", encoding, &noise);
            let _ = Layout::of_topic(&topic("p/msg/T", encoding, &noise), &Definitions::default());
        }
        // A real definition that is cut, with noise in the gap.
        let broken = format!("{}{noise}{}", &IDL[..cut], &IDL[cut..]);
        let _ = Layout::of_topic(&topic("valve_msgs/msg/Spool", "ros2idl", &broken), &Definitions::default());
        let _ = noise.parse::<FieldPath>();
    }

    #[test]
    fn paths_survive_the_round_trip(text in "[a-z_]{1,5}(\\[([0-9]{1,3}|[a-z]{1,3}=[a-z/ ]{0,4}[a-z])\\])?(\\.[a-z]{1,4}){0,2}") {
        let path: FieldPath = text.parse().unwrap();
        let written = path.to_string();
        prop_assert_eq!(written.parse::<FieldPath>().unwrap(), path);
    }
}

#[test]
fn every_common_interface_has_a_layout() {
    for type_name in [
        "std_msgs/Header",
        "std_msgs/Float64MultiArray",
        "geometry_msgs/WrenchStamped",
        "geometry_msgs/TransformStamped",
        "sensor_msgs/JointState",
        "sensor_msgs/FluidPressure",
        "sensor_msgs/Temperature",
        "sensor_msgs/Imu",
        "sensor_msgs/BatteryState",
        "control_msgs/DynamicJointState",
        "diagnostic_msgs/DiagnosticArray",
        "trajectory_msgs/JointTrajectoryPoint",
    ] {
        let layout = Layout::build(type_name, &[]).unwrap();
        assert!(!layout.structure(0).unwrap().members.is_empty(), "{type_name}");
    }
}
