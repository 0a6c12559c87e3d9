//! Documents the parameters of the nodes.

use excavator_ros::{Parameter, Value};

use crate::terminal::{self, filled};

/// Width of a help text on a wide terminal, equal to clap's limit.
const MOST_COLUMNS: usize = 100;

/// Parameters of a node by its name on the command line, in the order of their declaration.
pub(super) fn of(kind: &str) -> Vec<Parameter> {
    match kind {
        "arm-simulator" => excavator_nodes::arm_simulator::parameters(),
        "arm-bridge" => excavator_nodes::arm_bridge::parameters(),
        "joint-controller" => excavator_nodes::joint_controller::parameters(),
        "energy-monitor" => excavator_nodes::energy_monitor::parameters(),
        "identification" => excavator_nodes::identification_node::parameters(),
        _ => Vec::new(),
    }
}

/// The section on parameters in the help of a node.
pub(super) fn help(kind: &str) -> String {
    let parameters = of(kind);
    let longest = parameters.iter().map(|parameter| parameter.name.len()).max().unwrap_or(0);
    let indent = " ".repeat(longest + 4);
    let width = terminal::width().map_or(MOST_COLUMNS, |width| width.min(MOST_COLUMNS)).saturating_sub(indent.len());
    let lines = parameters.iter().map(|parameter| {
        let value = default(&parameter.value);
        let value = if value.is_empty() { String::new() } else { format!(" [default: {value}]") };
        let text = filled(&format!("{}{value}", parameter.description), Some(width));
        format!("  {:longest$}  {}", parameter.name, text.replace('\n', &format!("\n{indent}")))
    });
    format!("Parameters (--ros-args -p NAME:=VALUE):\n{}", lines.collect::<Vec<_>>().join("\n"))
}

/// A default as written after `-p name:=`; nothing for an empty text or list.
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
