//! Converts between the message of a machine's state and the sample of the model.

use excavator_model::Model;
use excavator_model::recording::{CylinderSample, Sample};
use excavator_msgs::common::JointState;
use excavator_msgs::{ArmState, CylinderState, Header, Time};
use excavator_ros::{Parameter, Value};

/// Name of [`frame_parameter`].
pub(crate) const FRAME: &str = "frame_id";

/// The frame in the headers of states. The default is the root link of the robot description that is made from a model.
pub(crate) fn frame_parameter() -> Parameter {
    Parameter::new(FRAME, Value::String("base_link".into()), "frame of the states in their headers").read_only()
}

/// The state in the order of the model's cylinders. A signal that is missing in the message counts as not measured.
pub(crate) fn sample(state: &ArmState, model: &Model) -> Sample {
    let cylinders = model
        .machine
        .cylinders
        .iter()
        .map(|cylinder| {
            state.cylinders.iter().find(|measured| measured.name == cylinder.name).map_or_else(
                CylinderSample::unmeasured,
                |measured| CylinderSample {
                    joint_angle: measured.joint_angle,
                    displacement: measured.displacement,
                    velocity: measured.velocity,
                    cap_pressure: measured.cap_pressure,
                    rod_pressure: measured.rod_pressure,
                    orifice_area: measured.orifice_area,
                    rod_force: measured.rod_force,
                },
            )
        })
        .collect();
    Sample {
        nanoseconds: state.header.stamp.nanoseconds(),
        cylinders,
        pump_pressure: state.pump_pressure,
        tank_pressure: state.tank_pressure,
        pump_flow: state.pump_flow,
    }
}

/// The message of a sample. Its cylinders have the order of the model's. Oil temperature is in °C.
pub(crate) fn arm_state(sample: &Sample, model: &Model, oil_temperature: f64) -> ArmState {
    let cylinders = model.machine.cylinders.iter().zip(&sample.cylinders).map(|(cylinder, known)| CylinderState {
        name: cylinder.name.clone(),
        joint_angle: known.joint_angle,
        displacement: known.displacement,
        velocity: known.velocity,
        cap_pressure: known.cap_pressure,
        rod_pressure: known.rod_pressure,
        orifice_area: known.orifice_area,
        rod_force: known.rod_force,
    });
    ArmState {
        header: Header {
            stamp: Time::from_nanoseconds(sample.nanoseconds).unwrap_or_default(),
            frame_id: String::new(),
        },
        cylinders: cylinders.collect(),
        pump_pressure: sample.pump_pressure,
        tank_pressure: sample.tank_pressure,
        pump_flow: sample.pump_flow,
        oil_temperature,
    }
}

/// The name that the joint of a cylinder has in joint states and robot descriptions.
pub fn joint_name(cylinder: &str) -> String {
    format!("{cylinder}_joint")
}

/// The message of the joints of a state. `rates` is in rad/s or m/s, or empty.
pub(crate) fn joint_state(state: &ArmState, rates: Vec<f64>) -> JointState {
    JointState {
        header: Header { stamp: state.header.stamp, frame_id: String::new() },
        name: state.cylinders.iter().map(|cylinder| joint_name(&cylinder.name)).collect(),
        position: state.cylinders.iter().map(|cylinder| cylinder.joint_angle).collect(),
        velocity: rates,
        effort: Vec::new(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;

    use super::*;

    #[test]
    fn a_state_comes_back_from_its_message_in_the_order_of_the_model() {
        let model = built_in("zx30u").unwrap();
        let cylinders = (0..model.machine.cylinders.len()).map(|number| CylinderSample {
            displacement: number as f64,
            cap_pressure: 1e6 + number as f64,
            velocity: 0.1,
            joint_angle: 0.2,
            rod_pressure: 2e6,
            orifice_area: 1e-5,
            rod_force: 3.0,
        });
        let known = Sample {
            nanoseconds: 1_700_000_000_123_456_789,
            cylinders: cylinders.collect(),
            pump_pressure: 7e6,
            tank_pressure: 1e5,
            pump_flow: 3.8e-4,
        };
        let mut message = arm_state(&known, &model, 27.0);
        assert_eq!(message.oil_temperature, 27.0);
        message.cylinders.reverse();
        assert_eq!(sample(&message, &model), known);
        message.cylinders.clear();
        assert!(sample(&message, &model).cylinders.iter().all(|cylinder| cylinder.displacement.is_nan()));
    }
}
