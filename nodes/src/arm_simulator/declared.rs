//! Parameters of the simulator.

use crate::arm_state::frame_parameter;
use crate::command_gate::parameters as gate_parameters;
use excavator_ros::{Lifecycle, Parameter, Value};

/// All of them, with units, ranges and defaults.
pub fn parameters() -> Vec<Parameter> {
    let double = |name, value, description| Parameter::new(name, Value::Double(value), description);
    let none = || Value::StringArray(Vec::new());
    let own = vec![
        Parameter::new("model", Value::String("zx30u-arm".into()), "built-in model or model file (.toml)").read_only(),
        Lifecycle::parameter(),
        frame_parameter(),
        double("rate", 1000.0, "samples per simulated second [Hz]").within(1.0, 5000.0).read_only(),
        double("speed", 1.0, "simulated seconds per second; /clock is published unless it is 1")
            .within(0.01, 10.0)
            .read_only(),
        Parameter::new("publish_clock", Value::Boolean(false), "publish simulated time on /clock").read_only(),
        Parameter::new(
            "start_displacement",
            Value::DoubleArray(Vec::new()),
            "piston displacement of each cylinder at the start, from mid-stroke [m]; empty: mid-stroke",
        )
        .within(-5.0, 5.0)
        .read_only(),
        double("supply_pressure", 0.0, "pressure of a supply that is kept from outside [Pa]; 0: as the machine says")
            .within(0.0, 1e8)
            .read_only(),
        double("oil_temperature", 27.0, "oil temperature that is reported [degC]").within(-50.0, 200.0),
        double("displacement_noise", 0.0, "standard deviation of displacement sensors [m]").within(0.0, 1.0),
        double("joint_angle_noise", 0.0, "standard deviation of joint angle sensors [rad]").within(0.0, 1.0),
        double("velocity_noise", 0.0, "standard deviation of velocity sensors [m/s]").within(0.0, 1.0),
        double("pressure_noise", 0.0, "standard deviation of pressure sensors [Pa]").within(0.0, 1e7),
        double("orifice_area_noise", 0.0, "standard deviation of spool sensors [m2]").within(0.0, 1e-3),
        double("displacement_quantum", 0.0, "resolution of displacement sensors [m]; 0: none").within(0.0, 1.0),
        double("joint_angle_quantum", 0.0, "resolution of joint angle sensors [rad]; 0: none").within(0.0, 1.0),
        double("pressure_quantum", 0.0, "resolution of pressure sensors [Pa]; 0: none").within(0.0, 1e7),
        double("dropout_probability", 0.0, "chance that one signal of a sample is missing (NaN)").within(0.0, 1.0),
        double("loss_probability", 0.0, "chance that a whole sample is never published").within(0.0, 1.0),
        Parameter::new(
            "not_measured",
            none(),
            "signals without a sensor: joint_angle, displacement, velocity, cap_pressure, rod_pressure, orifice_area, \
             pump_pressure, tank_pressure, pump_flow, oil_temperature",
        )
        .read_only(),
        Parameter::new("seed", Value::Integer(1), "draws noise, dropouts and losses").within(0.0, 9e15).read_only(),
    ];
    own.into_iter().chain(gate_parameters()).collect()
}
