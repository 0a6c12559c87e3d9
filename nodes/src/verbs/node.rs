//! `excavator node`

use crate::cli::NodeVerb;
use crate::error::VerbError;
use excavator_ros::RosArguments;

pub fn run(which: NodeVerb, ros: &RosArguments) -> Result<(), VerbError> {
    match which {
        NodeVerb::ArmSimulator => crate::arm_simulator::run(ros),
        NodeVerb::Identification => crate::identification_node::run(ros),
        NodeVerb::ArmBridge => crate::arm_bridge::run(ros),
        NodeVerb::JointController => crate::joint_controller::run(ros),
        NodeVerb::EnergyMonitor => crate::energy_monitor::run(ros),
    }
}
