//! Messages of other packages that live nodes exchange with the world: the same fields in the same order as
//! `std_msgs`, `sensor_msgs`, `diagnostic_msgs`, `rosgraph_msgs` and `rcl_interfaces` define them.

mod clock;
mod diagnostics;
mod flag;
mod fluid_pressure;
mod joint_state;
mod log;
mod text;

pub use clock::Clock;
pub use diagnostics::{DiagnosticArray, DiagnosticStatus, KeyValue};
pub use flag::Flag;
pub use fluid_pressure::FluidPressure;
pub use joint_state::JointState;
pub use log::Log;
pub use text::Text;
