//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::ros::{Remap, RosError};

/// Which physics is your hydraulic arm's model missing?
///
/// Compare a model with recordings, see where it fails, learn which physical effect is missing, add it, and watch the
/// error fall. Models are built-in names (zx30u-arm, zx30u, zx30u-bucket, servo-bench, emps) or TOML files; bags are rosbag2 folders with MCAP
/// or SQLite3 storage, or bare .mcap or .db3 files. With a map, any topic or column can be a signal.
#[derive(Debug, Parser)]
#[command(name = "excavator", version)]
pub struct Arguments {
    #[command(subcommand)]
    pub verb: Verb,
}

#[derive(Debug, Subcommand)]
pub enum Verb {
    /// The whole story on a made-up machine with a hidden effect; ends with a report to open.
    Demo(DemoArguments),
    /// Simulate a model with the input of a recording or with a command profile, into a bag.
    Simulate(SimulateArguments),
    /// Identify the unknown parameters of a model from recordings.
    Identify(IdentifyArguments),
    /// Simulate with a recording's input and compare every output with the measurement.
    Compare(CompareArguments),
    /// Read valve and friction off recordings without a simulation: directional gains, dead zone and hysteresis, leakage of
    /// the closed valve, friction against speed.
    Characterise(CharacteriseArguments),
    /// Where the energy went, and whether the model's ledger closes: H, dH/dt, losses by effect, pump line.
    Energy(EnergyArguments),
    /// Find out which physical effect the model is missing.
    Diagnose(DiagnoseArguments),
    /// Propose a manoeuvre that separates tied effects, or shows a parameter, within the machine's limits.
    Design(DesignArguments),
    /// Add effects, refit, and measure the error again.
    Refine(RefineArguments),
    /// The catalogue of physical effects, or one of them in full.
    Effects(EffectsArguments),
    /// What is in a bag: topics, clocks, signals, and what is missing for identification.
    Info(InfoArguments),
    /// Make a bag of a table (CSV, MATLAB, Parquet) or of other people's topics, through a map; or guess the map.
    Import(ImportArguments),
    /// Record topics into a bag.
    Record(RecordArguments),
    /// Play a bag.
    Play(PlayArguments),
    /// Simulator, energy monitor and recorder in one command.
    Up(UpArguments),
    /// A page with state, energies, ledger and alarms of the live topics as moving plots.
    Dashboard(DashboardArguments),
    /// A live ROS 2 node.
    #[command(subcommand)]
    Node(NodeVerb),
}

/// Live ROS 2 nodes. Each takes --ros-args (-r FROM:=TO, -r __node:=NAME, -r __ns:=NAMESPACE, -p NAME:=VALUE,
/// --params-file FILE, --log-level LEVEL).
#[derive(Debug, Subcommand)]
pub enum NodeVerb {
    /// A model as a machine: takes /arm/orifice_command, publishes /arm/state and /joint_states.
    ArmSimulator,
    /// Instruments of other makers as /arm/state: datagrams and topics, by a description (-p description:=FILE.toml).
    ArmBridge,
    /// The energy balance of the machine, state by state: takes /arm/state, publishes /arm/energy.
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

impl From<BagCompression> for excavator_bags::Compression {
    fn from(compression: BagCompression) -> Self {
        match compression {
            BagCompression::None => excavator_bags::Compression::None,
            BagCompression::Lz4 => excavator_bags::Compression::Lz4,
            BagCompression::Zstd => excavator_bags::Compression::Zstd,
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

#[derive(Debug, Args)]
pub struct UpArguments {
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

#[derive(Debug, Args)]
pub struct DashboardArguments {
    /// Port of the page; 0: any that is free.
    #[arg(long, default_value_t = 8050)]
    pub port: u16,
    /// Address that the page is offered at; 0.0.0.0: to everybody on the network.
    #[arg(long, default_value = "127.0.0.1")]
    pub host: String,
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
    /// Play these topics only.
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

fn positive(text: &str) -> Result<f64, String> {
    number(text, |value| value > 0.0, "a positive number")
}

fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |value| value >= 0.0, "zero or a positive number")
}

fn profile_duration(text: &str) -> Result<f64, String> {
    number(text, |value| (15.0..=600.0).contains(&value), "a number from 15 to 600")
}

fn stroke_margin(text: &str) -> Result<f64, String> {
    number(text, |value| (0.0..=0.4).contains(&value), "a share from 0 to 0.4")
}

fn number(text: &str, fits: fn(f64) -> bool, what: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && fits(value) && value < 1e9 => Ok(value),
        _ => Err(format!("{text} is not {what}")),
    }
}

#[derive(Debug, Args)]
pub struct Json {
    /// Write the result as JSON to this file ("-": standard output, instead of the table).
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct Mapping {
    /// Topic map (TOML): which field of which topic, or which column of a table, is which signal. Without, the map.toml
    /// in the bag's folder or FILE.map.toml beside the file is used, if there is one.
    #[arg(long, value_name = "MAP")]
    pub map: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct DemoArguments {
    /// Draws the machine, its hidden effect and its noise.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Folder for recordings, models and the report.
    #[arg(short, long, value_name = "FOLDER", default_value = "excavator-demo")]
    pub output: PathBuf,
}

#[derive(Debug, Args)]
pub struct SimulateArguments {
    /// Model: built-in name or TOML file.
    #[arg(long)]
    pub model: String,
    /// A bag whose inputs are used, or a profile (.toml) of sines, sweeps, trapezoids and holds.
    #[arg(long, value_name = "BAG|PROFILE")]
    pub input: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
    /// Bag to write.
    #[arg(short, long, value_name = "BAG")]
    pub output: PathBuf,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// Weak form of the equations with instruments from the simulated model: not biased by sensor noise.
    WeakForm,
    /// Ordinary least squares on smoothed differences, the recipe of Arai et al. 2021; biased by noise.
    LeastSquares,
    /// Weak form, then simulated outputs fitted to the measured ones.
    OutputError,
}

#[derive(Debug, Args)]
pub struct IdentifyArguments {
    /// Model: built-in name or TOML file.
    #[arg(long)]
    pub model: String,
    /// Recordings; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(long, required = true, num_args = 1.., value_name = "BAG")]
    pub bag: Vec<PathBuf>,
    #[command(flatten)]
    pub mapping: Mapping,
    /// Model file to write.
    #[arg(short, long, value_name = "MODEL")]
    pub output: Option<PathBuf>,
    /// How.
    #[arg(long, value_enum, default_value_t = Method::WeakForm)]
    pub method: Method,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Model: built-in name or TOML file.
    #[arg(long)]
    pub model: String,
    /// Recording; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(long, value_name = "BAG")]
    pub bag: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
    /// Write a page with plots of every signal, residuals, and error against command, speed, pressure and position.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
pub struct CharacteriseArguments {
    /// Recordings, taken together; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(required = true, num_args = 1.., value_name = "BAG")]
    pub bags: Vec<PathBuf>,
    /// Model: built-in name or TOML file. Areas, volumes, bulk modulus and load are taken from it.
    #[arg(long)]
    pub model: String,
    #[command(flatten)]
    pub mapping: Mapping,
    /// Write a page with gains, normalised flow, transients and friction, with their bands.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
pub struct EnergyArguments {
    /// Model: built-in name or TOML file.
    #[arg(long)]
    pub model: String,
    /// Recording, of any length.
    #[arg(long, value_name = "BAG")]
    pub bag: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
    /// Write a page with the flow of energy, rates of the stored energy, losses by effect, and the ledger.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
pub struct Recordings {
    /// Recordings that parameters are fitted to; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(long, required = true, num_args = 1.., value_name = "BAG")]
    pub identification: Vec<PathBuf>,
    /// Recordings that evidence is taken from; never fitted.
    #[arg(long, required = true, num_args = 1.., value_name = "BAG")]
    pub validation: Vec<PathBuf>,
    #[command(flatten)]
    pub mapping: Mapping,
}

#[derive(Debug, Args)]
pub struct DiagnoseArguments {
    /// Model: built-in name or TOML file.
    #[arg(long)]
    pub model: String,
    #[command(flatten)]
    pub recordings: Recordings,
    /// Write a page with the evidence.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["add", "auto"])))]
pub struct RefineArguments {
    /// Model: built-in name or TOML file.
    #[arg(long)]
    pub model: String,
    #[command(flatten)]
    pub recordings: Recordings,
    /// Effects to add, one after the other: EFFECT, EFFECT@CYLINDER or EFFECT@pump.
    #[arg(long, num_args = 1.., value_name = "EFFECT[@PLACE]")]
    pub add: Vec<String>,
    /// Add what the diagnosis finds, until nothing more is gained.
    #[arg(long)]
    pub auto: bool,
    /// Model file to write.
    #[arg(short, long, value_name = "MODEL")]
    pub output: PathBuf,
    /// Write a page with the story.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("what").required(true).multiple(true).args(["between", "parameter", "diagnosis"])))]
pub struct DesignArguments {
    /// Model: built-in name or TOML file.
    #[arg(long)]
    pub model: String,
    /// Effects to be told apart, with commas: EFFECT, EFFECT@CYLINDER, EFFECT@pump, or none for the model as it is. With
    /// --parameter: effects that the model is to have besides.
    #[arg(long, num_args = 1.., value_delimiter = ',', value_name = "EFFECT[@PLACE],...")]
    pub between: Vec<String>,
    /// Parameter to be determined (arm.inertia), instead of effects to be told apart.
    #[arg(long, value_name = "NAME")]
    pub parameter: Option<String>,
    /// What `diagnose --json` wrote: tied effects, fitted values and the sensors' noise are taken from there.
    #[arg(long, value_name = "FILE.json")]
    pub diagnosis: Option<PathBuf>,
    /// Profile to write.
    #[arg(short, long, value_name = "PROFILE.toml")]
    pub output: PathBuf,
    /// Longest profile, s: 15 to 600.
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = profile_duration)]
    pub duration: f64,
    /// Share of the stroke that is kept free at each end.
    #[arg(long, value_name = "SHARE", default_value_t = 0.08, value_parser = stroke_margin)]
    pub stroke_margin: f64,
    /// Highest pressure anywhere, Pa.
    #[arg(long, value_name = "PA", default_value_t = 2e7, value_parser = positive)]
    pub highest_pressure: f64,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
pub struct EffectsArguments {
    /// Effect to describe in full.
    pub name: Option<String>,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
pub struct InfoArguments {
    /// Bag, or a table with a map.
    pub bag: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
pub struct ImportArguments {
    /// Table (.csv, .tsv, .txt, .dat, .mat, .parquet) or bag.
    pub data: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
    /// Print a map guessed from names, types, units and the shapes of the signals, with a reason for each line. Check it!
    #[arg(long, conflicts_with = "map")]
    pub guess: bool,
    /// Cylinder that guessed signals belong to where their names do not say.
    #[arg(long, value_name = "NAME", default_value = "arm", requires = "guess")]
    pub cylinder: String,
    /// Bag to write; with --guess, the file for the map.
    #[arg(short, long, value_name = "BAG|MAP", required_unless_present = "guess")]
    pub output: Option<PathBuf>,
}
