//! `excavator_msgs/action/Identify` in Rust, and the types that all actions share.

use excavator_msgs::Time;
use serde::{Deserialize, Serialize};

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Goal {
    /// A file below the node's `model_folder`, a built-in name, or the text of a model.
    pub model: String,
    /// Bags below the node's `bag_folder`.
    pub bags: Vec<String>,
    /// Effects to add first.
    pub effects: Vec<String>,
}

/// Largest model, bag name and effect name in a goal, bytes. The largest built-in model has 11 kB.
const LONGEST: [usize; 3] = [64 * 1024, 1024, 256];
/// Most bags, and most effects, in a goal.
const MOST: usize = 64;

impl Goal {
    /// Checks that the goal is not too large to be worked on.
    ///
    /// # Errors
    /// The part that is too large, in one line.
    pub fn check_size(&self) -> Result<(), String> {
        let [model, bag, effect] = LONGEST;
        if self.model.len() > model {
            return Err(format!("its model has {} bytes, more than {model}", self.model.len()));
        }
        for (what, names, longest) in [("bags", &self.bags, bag), ("effects", &self.effects, effect)] {
            if names.len() > MOST {
                return Err(format!("it has {} {what}, more than {MOST}", names.len()));
            }
            if let Some(name) = names.iter().find(|name| name.len() > longest) {
                return Err(format!("a name among its {what} has {} bytes, more than {longest}", name.len()));
            }
        }
        Ok(())
    }
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
