//! Parameters of the nodes, for people.

use excavator_ros::{Parameter, Value};

/// Parameters of a node by its name on the command line, in the order of their declaration.
pub(super) fn of(kind: &str) -> Vec<Parameter> {
    match kind {
        "arm-simulator" => crate::arm_simulator::parameters(),
        "arm-bridge" => crate::arm_bridge::parameters(),
        "joint-controller" => crate::joint_controller::parameters(),
        "energy-monitor" => crate::energy_monitor::parameters(),
        "identification" => crate::identification_node::parameters(),
        _ => Vec::new(),
    }
}

/// What the help of a node says of its parameters.
pub(super) fn help(kind: &str) -> String {
    let parameters = of(kind);
    let width = parameters.iter().map(|parameter| parameter.name.len()).max().unwrap_or(0);
    let lines = parameters.iter().map(|parameter| {
        let value = default(&parameter.value);
        let value = if value.is_empty() { String::new() } else { format!(" [default: {value}]") };
        format!("  {:width$}  {}{value}", parameter.name, parameter.description)
    });
    format!("Parameters (--ros-args -p NAME:=VALUE):\n{}", lines.collect::<Vec<_>>().join("\n"))
}

/// A default as one writes it after `-p name:=`; nothing for an empty text or list.
pub(super) fn default(value: &Value) -> String {
    fn list<T: std::fmt::Debug>(values: &[T]) -> String {
        if values.is_empty() { String::new() } else { format!("{values:?}") }
    }
    match value {
        Value::Boolean(value) => value.to_string(),
        Value::Integer(value) => value.to_string(),
        Value::Double(value) => format!("{value:?}"),
        Value::String(value) => value.clone(),
        Value::BooleanArray(values) => list(values),
        Value::IntegerArray(values) => list(values),
        Value::DoubleArray(values) => list(values),
        Value::StringArray(values) => list(values),
    }
}
