//! Bytes as messages of known types.

use excavator_msgs::{ArmState, CylinderState, Header, Time};
use rosbag2::cdr;
use rosbag2::dynamic::{Layout, Selector, numeric_leaves};

/// Types that together have every kind of field.
const TYPES: [&str; 5] = [
    "excavator_msgs/ArmState",
    "sensor_msgs/JointState",
    "std_msgs/Float64MultiArray",
    "diagnostic_msgs/DiagnosticArray",
    "sensor_msgs/BatteryState",
];

pub fn run(bytes: &[u8]) -> bool {
    for type_name in TYPES {
        let Ok(layout) = Layout::build(type_name, &[]) else { continue };
        let _ = layout.check(bytes);
        for path in numeric_leaves(&layout, bytes).unwrap_or_default() {
            if let Ok(selector) = Selector::number(&layout, &path) {
                let _ = selector.read(&layout, bytes);
            }
        }
    }
    cdr::decode::<ArmState>(bytes).is_ok()
}

pub fn seeds() -> Vec<Vec<u8>> {
    let state = |cylinders: &[&str]| ArmState {
        header: Header { stamp: Time::default(), frame_id: "base".to_string() },
        cylinders: cylinders.iter().map(|name| CylinderState::unmeasured(name)).collect(),
        pump_pressure: 2e7,
        tank_pressure: 2e5,
        pump_flow: 3.8e-4,
        oil_temperature: 40.0,
    };
    [state(&["boom", "arm"]), state(&[])].iter().filter_map(|state| cdr::encode(state).ok()).collect()
}
