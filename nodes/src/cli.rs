//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// Which physics is your hydraulic arm's model missing?
///
/// Compare a model with recordings, see where it fails, learn which physical effect is missing, add it, and watch the
/// error fall. Models are built-in names (zx30u-arm, zx30u, emps) or TOML files; bags are rosbag2 folders with MCAP
/// storage or bare .mcap files.
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
    /// Find out which physical effect the model is missing.
    Diagnose(DiagnoseArguments),
    /// Add effects, refit, and measure the error again.
    Refine(RefineArguments),
    /// The catalogue of physical effects, or one of them in full.
    Effects(EffectsArguments),
    /// What is in a bag.
    Info(InfoArguments),
}

#[derive(Debug, Args)]
pub struct Json {
    /// Write the result as JSON to this file ("-": standard output, instead of the table).
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
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
    /// Recordings.
    #[arg(long, required = true, num_args = 1.., value_name = "BAG")]
    pub bag: Vec<PathBuf>,
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
    /// Recording.
    #[arg(long, value_name = "BAG")]
    pub bag: PathBuf,
    /// Write a page with plots of every signal, residuals, and error against command, speed, pressure and position.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
pub struct Recordings {
    /// Recordings that parameters are fitted to.
    #[arg(long, required = true, num_args = 1.., value_name = "BAG")]
    pub identification: Vec<PathBuf>,
    /// Recordings that evidence is taken from; never fitted.
    #[arg(long, required = true, num_args = 1.., value_name = "BAG")]
    pub validation: Vec<PathBuf>,
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
pub struct EffectsArguments {
    /// Effect to describe in full.
    pub name: Option<String>,
    #[command(flatten)]
    pub json: Json,
}

#[derive(Debug, Args)]
pub struct InfoArguments {
    /// Bag.
    pub bag: PathBuf,
    #[command(flatten)]
    pub json: Json,
}
