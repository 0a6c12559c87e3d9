//! Messages of other packages that nodes exchange with the outside: the same fields in the same order as in `std_msgs`,
//! `sensor_msgs`, `diagnostic_msgs`, `rosgraph_msgs`, `rcl_interfaces`
//! and `com3_msgs`.

mod clock;
mod diagnostics;
mod flag;
mod fluid_pressure;
mod joint_state;
mod log;
mod multi_array;
mod text;

pub use clock::Clock;
pub use diagnostics::{DiagnosticArray, DiagnosticStatus, KeyValue};
pub use flag::Flag;
pub use fluid_pressure::{FluidPressure, FluidPressureArray};
pub use joint_state::JointState;
pub use log::Log;
pub use multi_array::{Float64MultiArray, MultiArrayDimension, MultiArrayLayout};
pub use text::Text;
