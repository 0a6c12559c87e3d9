//! The part of a command line that every ROS 2 node understands: `--ros-args ... [--]`.

use std::path::PathBuf;

use super::value_text::from_text;
use super::{Remap, RosError, Value};

/// Least severe level that is logged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Level {
    Debug,
    Info,
    Warn,
    Error,
    Fatal,
}

impl Level {
    fn parse(text: &str) -> Option<Level> {
        match text.to_ascii_lowercase().as_str() {
            "debug" => Some(Level::Debug),
            "info" | "unset" => Some(Level::Info),
            "warn" | "warning" => Some(Level::Warn),
            "error" => Some(Level::Error),
            "fatal" => Some(Level::Fatal),
            _ => None,
        }
    }

    /// The number of `rcl_interfaces/msg/Log`.
    pub fn number(self) -> u8 {
        match self {
            Level::Debug => 10,
            Level::Info => 20,
            Level::Warn => 30,
            Level::Error => 40,
            Level::Fatal => 50,
        }
    }
}

/// A parameter given on the command line.
#[derive(Debug, Clone, PartialEq)]
pub struct Override {
    /// Node that it is for, `None` for all.
    pub node: Option<String>,
    /// Name of the parameter.
    pub name: String,
    /// Its value.
    pub value: Value,
}

/// The arguments after `--ros-args`.
#[derive(Debug, Clone, PartialEq)]
pub struct RosArguments {
    /// `-r`, `--remap`.
    pub remaps: Vec<Remap>,
    /// `-p`, `--param`.
    pub parameters: Vec<Override>,
    /// `--params-file`, in order.
    pub parameter_files: Vec<PathBuf>,
    /// `-e`, `--enclave`.
    pub enclave: Option<String>,
    /// `--log-level`.
    pub log_level: Level,
    /// `--disable-stdout-logs` turns it off.
    pub log_to_console: bool,
    /// `--disable-rosout-logs` turns it off.
    pub log_to_rosout: bool,
    /// `--disable-external-lib-logs` turns it off.
    pub log_to_file: bool,
    /// `--log-file-name`: prefix of the name of the log file.
    pub log_file_name: Option<String>,
    /// Arguments that have no effect, as messages for the user.
    pub ignored: Vec<String>,
}

impl Default for RosArguments {
    fn default() -> Self {
        RosArguments {
            remaps: Vec::new(),
            parameters: Vec::new(),
            parameter_files: Vec::new(),
            enclave: None,
            log_level: Level::Info,
            log_to_console: true,
            log_to_rosout: true,
            log_to_file: true,
            log_file_name: None,
            ignored: Vec::new(),
        }
    }
}

impl RosArguments {
    /// Splits `arguments` into those for ROS and all others.
    ///
    /// ```
    /// use excavator_ros::RosArguments;
    ///
    /// let words = ["play", "drive_1", "--ros-args", "-r", "__ns:=/left", "-p", "rate:=500"].map(String::from);
    /// let (ros, others) = RosArguments::parse(&words)?;
    /// assert_eq!(others, ["play", "drive_1"]);
    /// assert_eq!(ros.parameters[0].name, "rate");
    /// # Ok::<(), excavator_ros::RosError>(())
    /// ```
    ///
    /// # Errors
    /// [`RosError::Arguments`] with the argument that cannot be understood.
    pub fn parse(arguments: &[String]) -> Result<(Self, Vec<String>), RosError> {
        let mut ros = RosArguments::default();
        let mut others = Vec::new();
        let mut words = arguments.iter();
        let mut for_ros = false;
        while let Some(word) = words.next() {
            match (for_ros, word.as_str()) {
                (_, "--ros-args") => for_ros = true,
                (false, _) => others.push(word.clone()),
                (true, "--") => for_ros = false,
                (true, flag) => {
                    let mut next =
                        || words.next().ok_or_else(|| RosError::Arguments(format!("{flag} needs a value after it")));
                    ros.take(flag, &mut next)?;
                }
            }
        }
        Ok((ros, others))
    }

    fn take<'w>(&mut self, flag: &str, next: &mut dyn FnMut() -> Result<&'w String, RosError>) -> Result<(), RosError> {
        match flag {
            "-r" | "--remap" => self.remaps.push(remap(next()?)?),
            "-p" | "--param" => self.parameters.push(parameter(next()?)?),
            "--params-file" => self.parameter_files.push(PathBuf::from(next()?)),
            "--log-level" => self.log_level = level(next()?)?,
            "-e" | "--enclave" => self.enclave = Some(next()?.clone()),
            "--log-file-name" => self.log_file_name = Some(next()?.clone()),
            "--log-config-file" => {
                self.ignored.push(format!("{flag} {} has no effect: there is no other logger", next()?))
            }
            "--disable-stdout-logs" => self.log_to_console = false,
            "--disable-rosout-logs" => self.log_to_rosout = false,
            "--enable-stdout-logs" => self.log_to_console = true,
            "--enable-rosout-logs" => self.log_to_rosout = true,
            "--disable-external-lib-logs" => self.log_to_file = false,
            "--enable-external-lib-logs" => self.log_to_file = true,
            // Early ROS 2 had `name:=value` without -r.
            rule if rule.contains(":=") && !rule.starts_with('-') => self.remaps.push(remap(rule)?),
            other => return Err(RosError::Arguments(format!("unknown argument {other}"))),
        }
        Ok(())
    }
}

/// The arguments from `--ros-args` on, to pass to another node.
pub fn ros_words(arguments: &[String]) -> &[String] {
    let start = arguments.iter().position(|word| word == "--ros-args").unwrap_or(arguments.len());
    &arguments[start..]
}

fn level(text: &str) -> Result<Level, RosError> {
    // `--log-level name:=debug` sets the level of one logger. A node has only one logger here.
    let word = text.split_once(":=").map_or(text, |(_, level)| level);
    Level::parse(word)
        .ok_or_else(|| RosError::Arguments(format!("--log-level {text} is none of debug, info, warn, error, fatal")))
}

fn remap(text: &str) -> Result<Remap, RosError> {
    let Some((from, to)) = text.split_once(":=") else {
        return Err(RosError::Arguments(format!("-r {text} is not of the form FROM:=TO")));
    };
    let (node, from) = node_prefix(from);
    if from.is_empty() || to.is_empty() {
        return Err(RosError::Arguments(format!("-r {text} has an empty side")));
    }
    Ok(Remap { node, from, to: to.to_string() })
}

fn parameter(text: &str) -> Result<Override, RosError> {
    let Some((name, value)) = text.split_once(":=") else {
        return Err(RosError::Arguments(format!("-p {text} is not of the form NAME:=VALUE")));
    };
    let (node, name) = node_prefix(name);
    let value = from_text(value).ok_or_else(|| {
        RosError::Arguments(format!("-p {text}: the value is neither a scalar nor a list of one type"))
    })?;
    Ok(Override { node, name, value })
}

/// `node:name` or `name`.
fn node_prefix(text: &str) -> (Option<String>, String) {
    match text.split_once(':') {
        Some((node, name)) if !node.is_empty() && !name.starts_with("//") => {
            (Some(node.trim_start_matches('/').to_string()), name.to_string())
        }
        _ => (None, text.to_string()),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<(RosArguments, Vec<String>), RosError> {
        RosArguments::parse(&text.split_whitespace().map(str::to_string).collect::<Vec<_>>())
    }

    #[test]
    fn what_launch_writes_is_understood() {
        let (ros, others) = parse(
            "bag --ros-args -r __node:=sim -r /arm/state:=/left/state -p rate:=500 --params-file a.yaml \
             --log-level debug --enclave /arm/sim -- --loop --ros-args -p arm_simulator:seed:=3",
        )
        .unwrap();
        assert_eq!(others, ["bag", "--loop"]);
        assert_eq!(ros.remaps.len(), 2);
        assert_eq!(ros.parameters[0], Override { node: None, name: "rate".into(), value: Value::Integer(500) });
        assert_eq!(ros.parameters[1].node.as_deref(), Some("arm_simulator"));
        assert_eq!(ros.parameter_files, [PathBuf::from("a.yaml")]);
        assert_eq!(ros.enclave.as_deref(), Some("/arm/sim"));
        assert_eq!(ros.log_level, Level::Debug);
    }

    #[test]
    fn nonsense_is_refused_with_the_word_in_it() {
        for (text, word) in [
            ("--ros-args -r a", "-r a"),
            ("--ros-args -p", "-p"),
            ("--ros-args --log-level loud", "loud"),
            ("--ros-args --frobnicate", "--frobnicate"),
            ("--ros-args -p a:=[1,b]", "[1,b]"),
        ] {
            let message = parse(text).unwrap_err().to_string();
            assert!(message.contains(word), "{message}");
        }
    }
}
