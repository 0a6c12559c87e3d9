//! The verbs that run a node: `excavator node`, `record`, `play`, `dashboard`

use excavator_nodes::{
    arm_bridge, arm_simulator, energy_monitor, identification_node, joint_controller, player, recorder,
};
use excavator_ros::RosArguments;

#[cfg(feature = "dashboard")]
use crate::cli::DashboardArguments;
use crate::cli::{NodeVerb, PlayArguments, RecordArguments};
use crate::error::VerbError;

/// Runs a node until a stop is requested.
pub fn run(which: &NodeVerb, ros: &RosArguments) -> Result<(), VerbError> {
    let node = match which {
        NodeVerb::ArmSimulator => arm_simulator::run,
        NodeVerb::Identification => identification_node::run,
        NodeVerb::ArmBridge => arm_bridge::run,
        NodeVerb::JointController => joint_controller::run,
        NodeVerb::EnergyMonitor => energy_monitor::run,
    };
    Ok(node(ros)?)
}

/// Records topics into a bag.
pub fn record(arguments: RecordArguments, ros: &RosArguments) -> Result<(), VerbError> {
    Ok(recorder::run(&arguments.into(), ros)?)
}

/// Plays a bag.
pub fn play(arguments: PlayArguments, ros: &RosArguments) -> Result<(), VerbError> {
    let mut ros = ros.clone();
    ros.remaps.extend(arguments.remaps()?);
    Ok(player::run(&arguments.into(), &ros)?)
}

/// Shows the live topics on a page.
#[cfg(feature = "dashboard")]
pub fn dashboard(arguments: DashboardArguments, ros: &RosArguments) -> Result<(), VerbError> {
    let tell = |page: &str| crate::terminal::print(&format!("dashboard: {page}"));
    Ok(excavator_nodes::dashboard::run(&arguments.into(), ros, tell)?)
}

/// Runs the machine of an arm simulator, which starts this verb.
pub fn machine() -> Result<(), VerbError> {
    Ok(arm_simulator::run_machine()?)
}
