//! Simulates a model as a machine on the ROS graph.
//!
//! It consists of two processes: the node, which uses the network and contains the command gate, and the machine with its
//! valves, which no packet reaches (`machine_process`).

mod declared;
mod machine;
mod machine_process;
mod node;
mod sensors;
mod stamps;

pub use declared::parameters;
pub use machine::run as run_machine;
pub use node::run;

use excavator_model::Model;

/// Largest orifice area of each cylinder's valve, m²; zero where it has none.
fn valve_limits(model: &Model) -> Vec<f64> {
    let cylinders = model.machine.cylinders.iter();
    cylinders.map(|cylinder| cylinder.chambers.map_or(0.0, |chambers| chambers.full_command())).collect()
}
