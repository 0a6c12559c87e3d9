//! Arguments of the verbs that use the ROS graph.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

#[cfg(feature = "dashboard")]
use excavator_nodes::dashboard::PageOptions;
use excavator_nodes::player::PlayOptions;
use excavator_nodes::recorder::RecordingOptions;
use excavator_ros::{Remap, RosError};
use rosbag2::WriteOptions;

use super::numbers::{not_negative, positive};

/// Live ROS 2 nodes. Each takes --ros-args (-r FROM:=TO, -r __node:=NAME, -r __ns:=NAMESPACE, -p NAME:=VALUE,
/// --params-file FILE, --log-level LEVEL).
#[derive(Debug, Subcommand)]
pub enum NodeVerb {
    /// A model as a machine: takes arm/orifice_command, publishes arm/state and joint_states.
    ArmSimulator,
    /// Instruments of other makers as arm/state: datagrams and topics, by a description (-p description:=FILE.toml).
    ArmBridge,
    /// Joint commands of ros2_control as openings of valves: takes robot_joint_commands, publishes robot_joint_states.
    JointController,
    /// The energy balance of the machine, state by state: takes arm/state, publishes arm/energy.
    EnergyMonitor,
    /// The action /identification/run: identifies a model from bags, with feedback, cancellable.
    Identification,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BagCompression {
    /// Fastest to write.
    None,
    /// Fast, about half the size.
    Lz4,
    /// About a third of the size.
    Zstd,
}

impl From<BagCompression> for rosbag2::Compression {
    fn from(compression: BagCompression) -> Self {
        match compression {
            BagCompression::None => rosbag2::Compression::None,
            BagCompression::Lz4 => rosbag2::Compression::Lz4,
            BagCompression::Zstd => rosbag2::Compression::Zstd,
        }
    }
}

#[derive(Debug, Args)]
pub struct RecordArguments {
    /// Topics to record; all of them where neither names nor a pattern are given.
    pub topics: Vec<String>,
    /// Record all topics.
    #[arg(short, long)]
    pub all: bool,
    /// Record topics whose whole name matches.
    #[arg(short = 'e', long, value_name = "PATTERN")]
    pub regex: Option<String>,
    /// Leave out topics whose whole name matches.
    #[arg(short = 'x', long, value_name = "PATTERN")]
    pub exclude: Option<String>,
    /// Record plumbing too (topics with a part that begins with an underscore).
    #[arg(long)]
    pub include_hidden_topics: bool,
    /// Bag to write [default: rosbag2_ and the time].
    #[arg(short, long, value_name = "BAG")]
    pub output: Option<PathBuf>,
    /// Stop after this time, s.
    #[arg(short, long, value_name = "SECONDS", value_parser = positive)]
    pub duration: Option<f64>,
    /// Go on in another file of the bag when one has this size, bytes.
    #[arg(short = 'b', long, value_name = "BYTES", value_parser = clap::value_parser!(u64).range(1..))]
    pub max_bag_size: Option<u64>,
    /// Go on in another file of the bag when one has this length, s.
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub max_bag_duration: Option<f64>,
    /// Compression of the bag.
    #[arg(long, value_enum, default_value_t = BagCompression::Zstd)]
    pub compression: BagCompression,
}

impl From<RecordArguments> for RecordingOptions {
    fn from(arguments: RecordArguments) -> Self {
        // All of them: neither names nor a pattern.
        let (topics, pattern) = if arguments.all { (Vec::new(), None) } else { (arguments.topics, arguments.regex) };
        RecordingOptions {
            topics,
            pattern,
            exclude: arguments.exclude,
            hidden_topics: arguments.include_hidden_topics,
            bag: arguments.output,
            duration: arguments.duration,
            writing: WriteOptions {
                compression: arguments.compression.into(),
                most_file_bytes: arguments.max_bag_size,
                most_file_nanoseconds: arguments.max_bag_duration.map(|seconds| (seconds * 1e9) as u64),
                ..WriteOptions::default()
            },
        }
    }
}

#[derive(Debug, Args)]
pub struct UpArguments {
    /// Move every cylinder by itself, and show the dashboard.
    #[arg(long)]
    pub demo: bool,
    /// Show the dashboard at this port of this computer; 0: any that is free.
    #[cfg(feature = "dashboard")]
    #[arg(long, num_args = 0..=1, default_missing_value = "8050", value_name = "PORT")]
    pub dashboard: Option<u16>,
    /// Bag to write [default: rosbag2_ and the time].
    #[arg(short, long, value_name = "BAG")]
    pub output: Option<PathBuf>,
    /// Do not record.
    #[arg(long)]
    pub no_record: bool,
    /// Stop after this time, s.
    #[arg(short, long, value_name = "SECONDS", value_parser = positive)]
    pub duration: Option<f64>,
}

#[cfg(feature = "dashboard")]
#[derive(Debug, Args)]
pub struct DashboardArguments {
    /// Port of the page; 0: any that is free.
    #[arg(long, default_value_t = 8050)]
    pub port: u16,
    /// Address that the page listens on; 0.0.0.0 opens it to the whole network.
    #[arg(long, default_value = "127.0.0.1")]
    pub host: String,
    /// Name under which browsers may ask for the page, beside localhost and its address; may be given several times.
    #[arg(long, value_name = "NAME")]
    pub allow_host: Vec<String>,
}

#[cfg(feature = "dashboard")]
impl From<DashboardArguments> for PageOptions {
    fn from(DashboardArguments { port, host, allow_host }: DashboardArguments) -> Self {
        PageOptions { port, host, allowed_hosts: allow_host }
    }
}

#[derive(Debug, Args)]
pub struct PlayArguments {
    /// Bag.
    pub bag: PathBuf,
    /// How many times as fast as it was.
    #[arg(short, long, default_value_t = 1.0, value_parser = positive)]
    pub rate: f64,
    /// Begin again at the end.
    #[arg(short = 'l', long = "loop")]
    pub repeat: bool,
    /// Leave out the first seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = not_negative)]
    pub start_offset: f64,
    /// Play these topics only. Commands (OrificeCommand, */orifice_command, */stop) are played only when they are named
    /// here: a live machine would follow them.
    #[arg(long, num_args = 1.., value_name = "TOPIC")]
    pub topics: Vec<String>,
    /// Play topics under other names.
    #[arg(short = 'm', long, num_args = 1.., value_name = "FROM:=TO")]
    pub remap: Vec<String>,
    /// Publish bag time on /clock, so many times per second.
    #[arg(long, num_args = 0..=1, default_missing_value = "40", value_name = "HZ", value_parser = positive)]
    pub clock: Option<f64>,
    /// Wait for readers before the first message, s.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.5, value_parser = not_negative)]
    pub delay: f64,
    /// Begin paused. The space bar or SIGUSR1 pauses and goes on.
    #[arg(short = 'p', long)]
    pub start_paused: bool,
}

impl PlayArguments {
    /// The rules of `--remap`.
    pub fn remaps(&self) -> Result<Vec<Remap>, RosError> {
        self.remap
            .iter()
            .map(|rule| match rule.split_once(":=") {
                Some((from, to)) => Ok(Remap { node: None, from: from.to_string(), to: to.to_string() }),
                None => Err(RosError::Arguments(format!("--remap {rule} is not of the form FROM:=TO"))),
            })
            .collect()
    }
}

impl From<PlayArguments> for PlayOptions {
    fn from(arguments: PlayArguments) -> Self {
        PlayOptions {
            bag: arguments.bag,
            rate: arguments.rate,
            repeat: arguments.repeat,
            start_offset: arguments.start_offset,
            topics: arguments.topics,
            clock: arguments.clock,
            delay: arguments.delay,
            start_paused: arguments.start_paused,
        }
    }
}
