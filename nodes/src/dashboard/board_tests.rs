//! Tests of the fields of a frame.
#![allow(clippy::unwrap_used)]

use excavator_msgs::common::{DiagnosticStatus, KeyValue};
use excavator_msgs::{CylinderState, Header};

use super::*;

fn frame(board: &Board) -> Value {
    serde_json::from_str(&board.frame()).unwrap()
}

fn commands_of(name: &str, message: &str) -> DiagnosticArray {
    let value = KeyValue { key: "arm: commanded by".into(), value: "/player (source autonomy, priority 0)".into() };
    let status = DiagnosticStatus {
        level: 0,
        name: name.into(),
        message: message.into(),
        hardware_id: String::new(),
        values: vec![value],
    };
    DiagnosticArray { header: Header::default(), status: vec![status] }
}

#[test]
fn joint_angles_and_ages_are_told_and_unmeasured_is_null() {
    let board = Board::default();
    assert_eq!(frame(&board)["state_age"], Value::Null);
    let mut arm = CylinderState::unmeasured("arm");
    arm.joint_angle = 0.5;
    board.take_state(ArmState {
        header: Header::default(),
        cylinders: vec![arm, CylinderState::unmeasured("boom")],
        pump_pressure: 1e6,
        tank_pressure: f64::NAN,
        pump_flow: f64::NAN,
        oil_temperature: f64::NAN,
    });
    let frame = frame(&board);
    assert_eq!(frame["cylinders"]["arm"]["joint_angle"], json!(0.5));
    assert_eq!(frame["cylinders"]["boom"]["joint_angle"], Value::Null);
    assert!(frame["state_age"].as_f64().unwrap() < 10.0);
    assert_eq!((&frame["command_age"], &frame["oil_temperature"]), (&Value::Null, &Value::Null));
}

#[test]
fn the_owner_of_a_valve_and_the_stop_are_those_of_the_own_namespace() {
    let board = Board::in_namespace("/left");
    board.take_health(commands_of("left/arm_simulator: commands", "following commands"));
    board.take_health(commands_of("right/arm_simulator: commands", "stopped by /panel"));
    let frame = frame(&board);
    let gates = frame["gates"].as_array().unwrap();
    assert_eq!((gates.len(), &gates[0]["node"]), (1, &json!("arm_simulator")));
    assert_eq!(gates[0]["stopped_by"], Value::Null);
    assert_eq!(gates[0]["valves"]["arm"]["commanded_by"], "/player (source autonomy, priority 0)");
}

#[test]
fn a_description_is_handed_out_as_it_came() {
    let board = Board::default();
    assert_eq!(frame(&board)["machine"], 0);
    board.take_description("<robot name=\"</script>\"/>".into());
    board.take_model("no model");
    assert_eq!(frame(&board)["machine"], 1);
    let machine: Value = serde_json::from_str(&board.machine()).unwrap();
    assert_eq!(machine["description"], "<robot name=\"</script>\"/>");
}
