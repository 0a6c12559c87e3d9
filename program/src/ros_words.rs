//! Arguments after `--ros-args` on the command line.

use crate::error::VerbError;

/// Remappings, parameters and other arguments for a node. Without the feature `live` no verb accepts them, and they are
/// rejected like any unknown argument.
pub struct RosWords {
    /// The parsed arguments.
    #[cfg(feature = "live")]
    pub arguments: excavator_ros::RosArguments,
    /// The arguments as given, for the processes that are started.
    #[cfg(feature = "live")]
    pub words: Vec<String>,
}

impl RosWords {
    /// Splits a command line into these arguments and all others.
    ///
    /// # Errors
    /// [`VerbError::Node`] for arguments that cannot be parsed.
    #[cfg(feature = "live")]
    pub fn split(all: &[String]) -> Result<(Self, Vec<String>), VerbError> {
        let (arguments, others) = excavator_ros::RosArguments::parse(all)?;
        Ok((RosWords { arguments, words: excavator_ros::ros_words(all).to_vec() }, others))
    }

    /// Counts every argument of a command line among the others.
    #[cfg(not(feature = "live"))]
    pub fn split(all: &[String]) -> Result<(Self, Vec<String>), VerbError> {
        Ok((RosWords {}, all.to_vec()))
    }
}
