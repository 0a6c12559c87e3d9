//! The log of a node: standard error, `/rosout` and a file.

use excavator_msgs::Time;
use excavator_msgs::common::Log;
use rosbag2::printable;

use super::clock::system_nanoseconds;
use super::log_file::LogFile;
use super::{Level, Link, Outlet, RosArguments, RosError, TopicQos};

/// Number of log lines for late joiners of `/rosout`, and their lifespan, s: as in rcl.
const ROSOUT: TopicQos = TopicQos { depth: 1000, lifespan: Some(10), ..TopicQos::latched() };

/// The log of a node; clones share it.
#[derive(Clone)]
pub struct Logger {
    name: String,
    least: Level,
    console: bool,
    rosout: Option<Outlet<Log>>,
    file: Option<LogFile>,
}

impl Logger {
    /// The log of the link's node.
    ///
    /// # Errors
    /// [`RosError::Endpoint`].
    pub fn new(link: &Link, arguments: &RosArguments) -> Result<Self, RosError> {
        let rosout = arguments.log_to_rosout.then(|| link.publish("/rosout", ROSOUT)).transpose()?;
        let name = link.identity().full_name().trim_start_matches('/').replace('/', ".");
        let mut logger =
            Logger { name, least: arguments.log_level, console: arguments.log_to_console, rosout, file: None };
        if arguments.log_to_file {
            match LogFile::open(arguments.log_file_name.as_deref().unwrap_or(link.identity().name())) {
                Ok(file) => logger.file = Some(file),
                Err(reason) => logger.warn(format!("there is no log file: {reason}")),
            }
        }
        Ok(logger)
    }

    /// Logs information that users may want to follow.
    pub fn info(&self, message: impl Into<String>) {
        self.say(Level::Info, message.into());
    }

    /// Logs an unexpected condition.
    pub fn warn(&self, message: impl Into<String>) {
        self.say(Level::Warn, message.into());
    }

    /// Logs a failure.
    pub fn error(&self, message: impl Into<String>) {
        self.say(Level::Error, message.into());
    }

    fn say(&self, level: Level, message: String) {
        if level < self.least {
            return;
        }
        let stamp = Time::from_nanoseconds(system_nanoseconds()).unwrap_or_default();
        let word = format!("{level:?}").to_uppercase();
        let line = format!("[{word}] [{}.{:09}] [{}]: {message}", stamp.sec, stamp.nanosec, self.name);
        if self.console {
            eprintln!("{}", printable(&line));
        }
        if let Some(file) = &self.file {
            file.add(&line);
        }
        if let Some(rosout) = &self.rosout {
            let log = Log {
                stamp,
                level: level.number(),
                name: self.name.clone(),
                msg: message,
                file: String::new(),
                function: String::new(),
                line: 0,
            };
            // The line is already on the console. The log must not fail because of its own errors.
            let _ = rosout.publish(log);
        }
    }
}
