//! The command line.

#[cfg(feature = "live")]
mod live;
mod new_model;
mod numbers;
mod offline;
mod search;
mod shared;

use clap::{Parser, Subcommand};

use excavator_model::display::PressureUnit;

use crate::terminal::Verbosity;

#[cfg(feature = "live")]
pub use live::*;
pub use new_model::*;
pub use offline::*;
pub use search::*;
pub use shared::*;

/// Which physics is your hydraulic arm's model missing?
///
/// Compare a model with recordings, see where it fails, learn which physical effect is missing, add it, and watch the
/// error fall. Models are built-in names (zx30u-arm, zx30u, zx30u-bucket, zx30u-excavator, servo-bench, emps) or TOML files; bags are rosbag2 folders with MCAP
/// or SQLite3 storage, or bare .mcap or .db3 files. With a map, any topic or column can be a signal.
#[derive(Debug, Parser)]
#[command(name = "excavator", version)]
pub struct Arguments {
    #[command(subcommand)]
    pub verb: Verb,
    /// Show the technical detail behind the result as well.
    #[arg(short, long, global = true)]
    pub verbose: bool,
    /// Print errors only.
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Unit in which pressures are shown, in the terminal and on pages. JSON and files are always in SI units.
    #[arg(long, global = true, value_name = "UNIT", default_value = "MPa", ignore_case = true)]
    pub units: Units,
}

/// Unit in which pressures are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Units {
    /// Megapascal.
    #[value(name = "MPa")]
    Megapascal,
    /// Bar.
    #[value(name = "bar")]
    Bar,
}

impl From<Units> for PressureUnit {
    fn from(units: Units) -> Self {
        match units {
            Units::Megapascal => PressureUnit::Megapascal,
            Units::Bar => PressureUnit::Bar,
        }
    }
}

impl Arguments {
    /// How much the program says.
    pub fn verbosity(&self) -> Verbosity {
        match (self.quiet, self.verbose) {
            (true, _) => Verbosity::Quiet,
            (_, true) => Verbosity::Verbose,
            _ => Verbosity::Normal,
        }
    }
}

#[derive(Debug, Subcommand)]
pub enum Verb {
    /// The whole story on a simulated machine with a hidden effect; ends with a report to open.
    Demo(DemoArguments),
    /// From the tables of a bench and its data sheet to a verdict, step by step: map, model, steady reading, comparison, diagnosis.
    Start(StartArguments),
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
    /// What changed in a machine, as after a repair: its parameters before and after, with intervals.
    Changed(ChangedArguments),
    /// Find out which physical effect the model is missing.
    Diagnose(DiagnoseArguments),
    /// Propose laws outside the catalogue, as formulas, for the physics that a model is missing.
    Propose(ProposeArguments),
    /// Propose a manoeuvre that separates tied effects, or shows a parameter, within the machine's limits.
    Design(DesignArguments),
    /// Add effects, refit, and measure the error again.
    Refine(RefineArguments),
    /// Print a saved study again: the same lines, page and JSON, without a search.
    Report(ReportArguments),
    /// The catalogue of physical effects, or one of them in full.
    Effects(EffectsArguments),
    /// Write a new model file, check one; schema and reference page of such files.
    #[command(subcommand)]
    Model(ModelVerb),
    /// What is in a bag: topics, clocks, signals, and what is missing for identification.
    Info(InfoArguments),
    /// Plot recordings over each other, on one page, without a model.
    View(ViewArguments),
    /// Make a bag of a table (CSV, spreadsheet, MATLAB, Parquet) or of other people's topics, through a map; or guess the map.
    Import(ImportArguments),
    /// Make a bag whose recorder was killed readable for ros2 bag and other readers.
    Reindex(ReindexArguments),
    /// Record topics into a bag.
    #[cfg(feature = "live")]
    Record(RecordArguments),
    /// Play a bag.
    #[cfg(feature = "live")]
    Play(PlayArguments),
    /// Simulator, energy monitor and recorder in one command.
    #[cfg(feature = "live")]
    Up(UpArguments),
    /// A page with state, energies, ledger and alarms of the live topics as moving plots.
    #[cfg(feature = "dashboard")]
    Dashboard(DashboardArguments),
    /// A live ROS 2 node.
    #[cfg(feature = "live")]
    #[command(subcommand)]
    Node(NodeVerb),
    /// Print the completions of a shell, for its start-up file.
    Completions {
        /// Shell.
        shell: clap_complete::Shell,
    },
    /// Man pages, schemas, and pages of the docs that are made of the program.
    #[command(subcommand, hide = true)]
    Manual(ManualVerb),
    /// The simulated machine of an arm simulator, which starts it.
    #[cfg(feature = "live")]
    #[command(hide = true)]
    Machine,
}

/// What is made of the program.
#[derive(Debug, Subcommand)]
pub enum ManualVerb {
    /// Write man pages, one for each verb.
    Man {
        /// Folder to write them to.
        #[arg(long, value_name = "FOLDER")]
        to: std::path::PathBuf,
    },
    /// Write the JSON schema of each result of `--json`.
    Schemas {
        /// Folder to write them to.
        #[arg(long, value_name = "FOLDER")]
        to: std::path::PathBuf,
    },
    /// Print the page of the verbs, in Markdown.
    Verbs,
    /// Print the page of the nodes' parameters, in Markdown.
    #[cfg(feature = "live")]
    Parameters,
    /// Print the page of the results of `--json`, in Markdown.
    Results,
}
