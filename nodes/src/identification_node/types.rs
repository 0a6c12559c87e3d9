//! `excavator_msgs/action/Identify` in Rust, and what every action has in common.

use excavator_msgs::Time;
use serde::{Deserialize, Serialize};

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Goal {
    /// A model file, a built-in name, or the text of a model.
    pub model: String,
    /// Bags.
    pub bags: Vec<String>,
    /// Effects to add first.
    pub effects: Vec<String>,
}

/// What came of it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Outcome {
    /// The identified model as text; empty without success.
    pub model: String,
    /// Names of the signals.
    pub signals: Vec<String>,
    /// Normalised mean square errors of the given model.
    pub nmse_before: Vec<f64>,
    /// The same of the identified model.
    pub nmse_after: Vec<f64>,
    /// Whether it was done.
    pub success: bool,
    /// What was done, or why it failed.
    pub message: String,
}

/// How far it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Feedback {
    /// What is being done.
    pub stage: String,
    /// 0 to 1.
    pub progress: f64,
}

impl ros2_client::Message for Goal {}
impl ros2_client::Message for Outcome {}
impl ros2_client::Message for Feedback {}

/// Identity of a goal.
pub(super) type GoalId = [u8; 16];

/// `action_msgs/msg/GoalInfo`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct GoalInfo {
    /// Which goal; zeros in a cancel request mean any.
    pub goal_id: GoalId,
    /// When it was accepted; zero in a cancel request means any time.
    pub stamp: Time,
}
