//! Arguments of the other verbs that work on files.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use excavator_identification::identify;

use super::{
    Extent, Mapping, ModelChoice, NewModelArguments, Overwriting, OwnEffects, PositionTestArguments, ResultFile,
    ValveTestArguments,
};

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
    #[command(flatten)]
    pub model: ModelChoice,
    /// A bag whose inputs are used, or a profile (.toml) of sines, sweeps, trapezoids and holds.
    #[arg(long, value_name = "BAG|PROFILE")]
    pub input: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
    /// Bag to write.
    #[arg(short, long, value_name = "BAG")]
    pub output: PathBuf,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// The one of weak form, output error and simulation error that predicts the last third of the recordings best from the rest. The
    /// weak form is kept unless another is clearly better.
    Best,
    /// Weak form of the equations with instruments from the simulated model: not biased by sensor noise.
    WeakForm,
    /// Ordinary least squares on smoothed differences, the recipe of Arai et al. 2021; biased by noise.
    LeastSquares,
    /// Weak form, then simulated outputs fitted to the measured ones over short segments, with the errors of instruments as unknowns.
    OutputError,
    /// Weak form, then outputs fitted that are simulated from measured states: what `compare` judges.
    SimulationError,
}

impl From<Method> for identify::Method {
    fn from(method: Method) -> Self {
        match method {
            Method::Best => identify::Method::Best,
            Method::WeakForm => identify::Method::WeakForm,
            Method::LeastSquares => identify::Method::LeastSquares,
            Method::OutputError => identify::Method::OutputError,
            Method::SimulationError => identify::Method::SimulationError,
        }
    }
}

#[derive(Debug, Args)]
pub struct IdentifyArguments {
    #[command(flatten)]
    pub model: ModelChoice,
    /// Recordings; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(long, required = true, num_args = 1.., value_name = "BAG")]
    pub bag: Vec<PathBuf>,
    #[command(flatten)]
    pub mapping: Mapping,
    #[command(flatten)]
    pub extent: Extent,
    /// Model file to write.
    #[arg(short, long, value_name = "MODEL")]
    pub output: Option<PathBuf>,
    /// How parameters are estimated.
    #[arg(long, value_enum, default_value_t = Method::Best)]
    pub method: Method,
    #[command(flatten)]
    pub result: ResultFile,
}

#[derive(Debug, Args)]
pub struct CompareArguments {
    #[command(flatten)]
    pub model: ModelChoice,
    /// Recording; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(long, value_name = "BAG")]
    pub bag: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
    #[command(flatten)]
    pub extent: Extent,
    /// Another model, for the same recording: in the table and on every plot beside the first.
    #[arg(long, value_name = "MODEL")]
    pub against: Option<String>,
    /// Another run of the same commands, aligned with the first: how well the machine repeats itself.
    #[arg(long, value_name = "BAG")]
    pub repeat: Option<PathBuf>,
    /// Write a page with plots of every signal, residuals, and error against command, speed, pressure and position.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub result: ResultFile,
}

#[derive(Debug, Args)]
pub struct StartArguments {
    /// Tables or bags of one machine. All but the last are for the fit, the last judges; a single one is cut in halves.
    #[arg(required = true, value_name = "TABLE|BAG")]
    pub data: Vec<PathBuf>,
    /// Data sheet (TOML): options of `model new` by their names, and `[columns.HEADING]` with signal, scale and zero. A sheet with
    /// `drop` and without `drive` is that of a static valve test.
    #[arg(long, value_name = "FILE")]
    pub sheet: PathBuf,
    /// Folder for model, map, page and study.
    #[arg(long, value_name = "FOLDER", default_value = "start")]
    pub to: PathBuf,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

#[derive(Debug, Args)]
pub struct CharacteriseArguments {
    /// Recordings, taken together; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(required = true, num_args = 1.., value_name = "BAG")]
    pub bags: Vec<PathBuf>,
    #[command(flatten)]
    pub model: ModelChoice,
    #[command(flatten)]
    pub mapping: Mapping,
    /// Model file to write, with null, gains, friction, weight and stops as they were read: starts for identify and diagnose.
    #[arg(short, long, value_name = "MODEL")]
    pub output: Option<PathBuf>,
    /// Write a page with gains, normalised flow, transients and friction, with their bands.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub result: ResultFile,
}

#[derive(Debug, Args)]
pub struct ChangedArguments {
    #[command(flatten)]
    pub model: ModelChoice,
    /// Recordings before; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(long, required = true, num_args = 1.., value_name = "BAG")]
    pub before: Vec<PathBuf>,
    /// Recordings after.
    #[arg(long, required = true, num_args = 1.., value_name = "BAG")]
    pub after: Vec<PathBuf>,
    #[command(flatten)]
    pub mapping: Mapping,
    #[command(flatten)]
    pub extent: Extent,
    /// Write a page with what changed and what did not.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub result: ResultFile,
}

#[derive(Debug, Args)]
pub struct EnergyArguments {
    #[command(flatten)]
    pub model: ModelChoice,
    /// Recording, of any length.
    #[arg(long, value_name = "BAG")]
    pub bag: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
    /// Write a page with the flow of energy, rates of the stored energy, losses by effect, and the ledger.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub result: ResultFile,
}

#[derive(Debug, Args)]
pub struct EffectsArguments {
    /// Effect to describe in full.
    pub name: Option<String>,
    #[command(flatten)]
    pub own: OwnEffects,
    /// Check the formulas of these files over the range of a machine and draw them: finite, without jumps, and do they put energy in?
    #[arg(long, num_args = 1.., value_name = "FILE|FOLDER", conflicts_with_all = ["name", "catalogue", "json"])]
    pub check: Vec<PathBuf>,
    /// Machine on which formulas are checked: the built-in name or file of a model.
    #[arg(long, value_name = "MODEL", default_value = "zx30u-arm", requires = "check")]
    pub model: String,
    /// Print what a formula may use: rows, variables, functions.
    #[arg(long, conflicts_with_all = ["name", "catalogue", "check", "json"])]
    pub language: bool,
    #[command(flatten)]
    pub result: ResultFile,
}

#[derive(Debug, Subcommand)]
pub enum ModelVerb {
    /// Write a commented model file for a machine of which you have the data sheet: by options, or by five questions.
    New(Box<NewModelArguments>),
    /// Read a model, try the machine, and tell which of its numbers are odd.
    Check(ModelCheckArguments),
    /// Take flow gains, dead zone and play of a valve from a static test: a table of flow against input.
    Valve(Box<ValveTestArguments>),
    /// Fit a model from reference to position of a drive under its own controller: gain, dead band, lag, delay, bandwidth.
    Position(Box<PositionTestArguments>),
    /// Print the robot description (URDF) of a model's machine, for RViz and robot_state_publisher.
    Urdf(ModelChoice),
    /// Print the JSON schema of the model file, for editors that complete and check TOML.
    Schema(OwnEffects),
    /// Print the reference page of the model file: every table, key, unit and default.
    Reference(OwnEffects),
}

#[derive(Debug, Args)]
pub struct ModelCheckArguments {
    /// Model file (TOML), or a built-in name.
    pub file: String,
    #[command(flatten)]
    pub own: OwnEffects,
    #[command(flatten)]
    pub result: ResultFile,
}

#[derive(Debug, Args)]
pub struct InfoArguments {
    /// Bag, or a table with a map.
    pub bag: PathBuf,
    /// Topic map (TOML), or `opera`; without, the map.toml in the bag's folder or FILE.map.toml beside the file, if there is one.
    #[arg(long, value_name = "MAP")]
    pub map: Option<PathBuf>,
    /// Namespace of the machine, for a bag of our own topics, or of OPERA's, that has several.
    #[arg(long, value_name = "NAMESPACE")]
    pub namespace: Option<String>,
    #[command(flatten)]
    pub result: ResultFile,
}

#[derive(Debug, Args)]
pub struct ViewArguments {
    /// Recordings; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(required = true, num_args = 1.., value_name = "BAG")]
    pub bags: Vec<PathBuf>,
    /// Page to write.
    #[arg(long, value_name = "FILE.html")]
    pub report: PathBuf,
    /// Plot this signal, as in arm.cap_pressure; without, all that are measured. Repeat it for several.
    #[arg(long, value_name = "SIGNAL")]
    pub signal: Vec<String>,
    /// Count time from the first motion of each recording, so that runs of one manoeuvre lie over each other.
    #[arg(long)]
    pub from_motion: bool,
    /// Topic map (TOML), or `opera`; without, the map.toml in the bag's folder or FILE.map.toml beside the file, if there is one.
    #[arg(long, value_name = "MAP")]
    pub map: Option<PathBuf>,
    /// Namespace of the machine, for a bag of our own topics, or of OPERA's, that has several.
    #[arg(long, value_name = "NAMESPACE")]
    pub namespace: Option<String>,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

#[derive(Debug, Args)]
pub struct ImportArguments {
    /// Table (.csv, .tsv, .txt, .dat, .lvm, .asc, .xlsx, .mat, .parquet; text also with .gz) or bag. Several: one recording in pieces,
    /// one after the other.
    #[arg(required = true, value_name = "DATA")]
    pub data: Vec<PathBuf>,
    /// Topic map (TOML), or `opera`; without, the map.toml in the bag's folder or FILE.map.toml beside the file, if there is one.
    #[arg(long, value_name = "MAP")]
    pub map: Option<PathBuf>,
    /// Table that was recorded beside DATA: its columns are available to the map, at the times of DATA. Repeat it for several.
    #[arg(long, value_name = "FILE", conflicts_with = "guess")]
    pub join: Vec<PathBuf>,
    /// Print a map guessed from names, types, units and the shapes of the signals, with a reason for each line. Check it! On a
    /// terminal, asks where it is not sure; else leaves that commented out.
    #[arg(long, conflicts_with = "map")]
    pub guess: bool,
    /// Cylinder that guessed signals belong to where their names do not say; without, the model's first one, or "arm".
    #[arg(long, value_name = "NAME", requires = "guess")]
    pub cylinder: Option<String>,
    /// Model that the recording is for, which says names and strokes of cylinders.
    #[arg(long, value_name = "MODEL", requires = "guess")]
    pub model: Option<String>,
    /// Data sheet (TOML) that says what columns measure: `[columns.HEADING]` with signal, scale and zero.
    #[arg(long, value_name = "FILE", requires = "guess")]
    pub sheet: Option<PathBuf>,
    /// Bag to write; with --guess, the file for the map.
    #[arg(short, long, value_name = "BAG|MAP", required_unless_present = "guess")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

#[derive(Debug, Args)]
pub struct ReindexArguments {
    /// Folder of the bag, or a bare .mcap file.
    #[arg(value_name = "BAG")]
    pub bag: PathBuf,
    /// Keep the original of each file that is written anew beside it, as NAME.damaged.
    #[arg(long)]
    pub keep: bool,
}
