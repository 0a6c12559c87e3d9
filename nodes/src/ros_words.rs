//! What stands after `--ros-args` in the command line.

use crate::error::VerbError;

/// Remappings, parameters and other words for a node. Without the feature `live` nothing takes them, and they are refused as any other
/// words that nobody knows.
pub struct RosWords {
    /// What they mean.
    #[cfg(feature = "live")]
    pub arguments: excavator_ros::RosArguments,
    /// As they were given, for the parts that are started.
    #[cfg(feature = "live")]
    pub words: Vec<String>,
}

impl RosWords {
    /// Those of a command line, and all other words of it.
    ///
    /// # Errors
    /// [`VerbError::Ros`] for words that are not understood.
    #[cfg(feature = "live")]
    pub fn split(all: &[String]) -> Result<(Self, Vec<String>), VerbError> {
        let (arguments, others) = excavator_ros::RosArguments::parse(all)?;
        Ok((RosWords { arguments, words: excavator_ros::ros_words(all).to_vec() }, others))
    }

    /// All words of a command line are others.
    #[cfg(not(feature = "live"))]
    pub fn split(all: &[String]) -> Result<(Self, Vec<String>), VerbError> {
        Ok((RosWords {}, all.to_vec()))
    }
}
