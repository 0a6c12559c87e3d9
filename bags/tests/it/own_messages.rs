//! Our own messages, read by their definitions as those of other people.

use excavator_bags::own_definitions;
use excavator_msgs::{ArmState, CylinderState, Header, Message, Time, definitions};
use rosbag2::cdr;
use rosbag2::dynamic::{Definitions, Layout, Selector, numeric_leaves};

fn number(layout: &Layout, path: &str, message: &[u8]) -> Option<f64> {
    Selector::number(layout, &path.parse().unwrap()).unwrap().read(layout, message).unwrap()
}

fn state() -> ArmState {
    let cylinder = |name: &str, seed: f64| CylinderState {
        name: name.to_string(),
        displacement: seed,
        rod_force: seed + 1.0,
        ..CylinderState::unmeasured(name)
    };
    ArmState {
        header: Header { stamp: Time { sec: 5, nanosec: 7 }, frame_id: "odd".to_string() },
        cylinders: vec![cylinder("boom", 1.0), cylinder("arm", 10.0), cylinder("bucket", 100.0)],
        pump_pressure: 2e7,
        tank_pressure: 1e5,
        pump_flow: 1e-3,
        oil_temperature: 44.0,
    }
}

#[test]
fn our_own_messages_read_as_with_the_typed_decoder() {
    let schema = definitions::schema(ArmState::TYPE_NAME).unwrap();
    let definitions = Definitions::from_schema(ArmState::TYPE_NAME, "ros2msg", &schema).unwrap();
    let layout = Layout::build(ArmState::TYPE_NAME, &[&definitions]).unwrap();
    let bytes = cdr::encode(&state()).unwrap();
    layout.check(&bytes).unwrap();
    for (path, expected) in [
        ("pump_pressure", Some(2e7)),
        ("oil_temperature", Some(44.0)),
        ("cylinders[name=arm].displacement", Some(10.0)),
        ("cylinders[2].rod_force", Some(101.0)),
        ("cylinders[3].rod_force", None),
        ("cylinders[name=swing].rod_force", None),
        ("header.stamp.nanosec", Some(7.0)),
    ] {
        assert_eq!(number(&layout, path, &bytes), expected, "{path}");
    }
    let stamp = Selector::time(&layout, &"header.stamp".parse().unwrap()).unwrap();
    assert_eq!(stamp.read_time(&layout, &bytes).unwrap(), Some(5_000_000_007));
    let leaves: Vec<String> = numeric_leaves(&layout, &bytes).unwrap().iter().map(ToString::to_string).collect();
    assert!(leaves.contains(&"cylinders[name=bucket].cap_pressure".to_string()), "{leaves:?}");
    assert_eq!(leaves.len(), 2 + 3 * 7 + 4);
}

#[test]
fn every_own_message_has_a_layout_without_a_definition_in_the_bag() {
    for name in ["ArmState", "OrificeCommand", "EnergyState"] {
        let layout = Layout::build(&format!("excavator_msgs/msg/{name}"), &[own_definitions()]).unwrap();
        assert!(!layout.structure(0).unwrap().members.is_empty(), "{name}");
    }
}
