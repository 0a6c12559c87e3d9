//! Arguments of the verbs that work on files.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Subcommand, ValueEnum};
use excavator_bags::map::Origin;
use excavator_identification::checks::OVERRULABLE;
use excavator_identification::identify;

use super::numbers::{positive, profile_duration, stroke_margin};
use super::{NewModelArguments, ValveTestArguments};

#[derive(Debug, Args)]
pub struct Json {
    /// Write the result as JSON to this file ("-": standard output, instead of the table).
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

#[derive(Debug, Default, Clone, Copy, Args)]
pub struct Overwriting {
    /// Replace files that exist; never one that this command reads.
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Default, Clone, Args)]
pub struct Mapping {
    /// Topic map (TOML): which field of which topic, or which column of a table, is which signal. Without, the map.toml
    /// in the bag's folder or FILE.map.toml beside the file is used, if there is one.
    #[arg(long, value_name = "MAP")]
    pub map: Option<PathBuf>,
    /// Namespace of the machine, for a bag of our own topics that has several.
    #[arg(long, value_name = "NAMESPACE", conflicts_with = "map")]
    pub namespace: Option<String>,
    /// Use a recording although this check refuses it; the refusal says its name. Repeat it for several.
    #[arg(long, value_name = "CHECK", value_parser = PossibleValuesParser::new(OVERRULABLE), hide_possible_values = true)]
    pub accept: Vec<String>,
    /// Compare only where this formula holds, as in "abs(v) > 0.002" (SI units). The rest is simulated, not compared. Repeat to
    /// combine.
    #[arg(long = "where", value_name = "CONDITION")]
    pub conditions: Vec<String>,
}

impl Mapping {
    /// Where signals are found.
    pub fn origin(&self) -> Origin<'_> {
        Origin { map: self.map.as_deref(), namespace: self.namespace.as_deref() }
    }
}

#[derive(Debug, Default, Clone, Copy, Args)]
pub struct Extent {
    /// Use all of a recording of more than three minutes, not only its most informative stretches: slow, and in memory
    /// as a whole.
    #[arg(long)]
    pub whole: bool,
}

#[derive(Debug, Clone, Args)]
pub struct ModelChoice {
    /// Model: built-in name or TOML file.
    #[arg(long)]
    pub model: String,
    #[command(flatten)]
    pub own: OwnEffects,
}

impl ModelChoice {
    /// The files that it names.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        std::iter::once(PathBuf::from(&self.model)).chain(self.own.catalogue.iter().cloned())
    }
}

#[derive(Debug, Default, Clone, Args)]
pub struct OwnEffects {
    /// Your own effects, written as formulas: a file (TOML), or a folder with such files. Repeat it for several.
    #[arg(long, value_name = "FILE|FOLDER")]
    pub catalogue: Vec<PathBuf>,
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
    /// Weak form of the equations with instruments from the simulated model: not biased by sensor noise.
    WeakForm,
    /// Ordinary least squares on smoothed differences, the recipe of Arai et al. 2021; biased by noise.
    LeastSquares,
    /// Weak form, then simulated outputs fitted to the measured ones.
    OutputError,
}

impl From<Method> for identify::Method {
    fn from(method: Method) -> Self {
        match method {
            Method::WeakForm => identify::Method::WeakForm,
            Method::LeastSquares => identify::Method::LeastSquares,
            Method::OutputError => identify::Method::OutputError,
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
    /// How.
    #[arg(long, value_enum, default_value_t = Method::WeakForm)]
    pub method: Method,
    #[command(flatten)]
    pub json: Json,
    #[command(flatten)]
    pub overwriting: Overwriting,
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
    pub json: Json,
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
    /// Write a page with gains, normalised flow, transients and friction, with their bands.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
    #[command(flatten)]
    pub overwriting: Overwriting,
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
    pub json: Json,
    #[command(flatten)]
    pub overwriting: Overwriting,
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
    #[command(flatten)]
    pub extent: Extent,
}

impl Recordings {
    /// All recordings.
    pub fn bags(&self) -> impl Iterator<Item = &PathBuf> {
        self.identification.iter().chain(&self.validation)
    }
}

#[derive(Debug, Args)]
pub struct DiagnoseArguments {
    #[command(flatten)]
    pub model: ModelChoice,
    #[command(flatten)]
    pub recordings: Recordings,
    /// Write a page with the evidence.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Save the diagnosis with its fitted models, for `refine --diagnosis FILE`.
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,
    /// Write what the verdict was decided from: errors of every hypothesis in every block of time, as JSON.
    #[arg(long, value_name = "FILE")]
    pub scores: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

#[derive(Debug, Args)]
pub struct ProposeArguments {
    #[command(flatten)]
    pub model: ModelChoice,
    #[command(flatten)]
    pub recordings: Recordings,
    /// Catalogue file to write: the proposed laws, best first, with fitted values.
    #[arg(short, long, value_name = "FILE.toml")]
    pub output: Option<PathBuf>,
    /// Write a page with the evidence.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["add", "auto", "diagnosis"])))]
pub struct RefineArguments {
    /// Add what this diagnosis found (`diagnose --save FILE`), without a search: model and recordings are those of the diagnosis.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["model", "catalogue", "identification", "report"])]
    pub diagnosis: Option<PathBuf>,
    /// Model: built-in name or TOML file.
    #[arg(long, required_unless_present = "diagnosis")]
    pub model: Option<String>,
    #[command(flatten)]
    pub own: OwnEffects,
    /// Recordings that parameters are fitted to; `BAG@20..40` is the part of one from 20 s to 40 s.
    #[arg(long, required_unless_present = "diagnosis", num_args = 1.., value_name = "BAG")]
    pub identification: Vec<PathBuf>,
    /// Recordings that evidence is taken from; never fitted.
    #[arg(long, required_unless_present = "diagnosis", num_args = 1.., value_name = "BAG")]
    pub validation: Vec<PathBuf>,
    #[command(flatten)]
    pub mapping: Mapping,
    #[command(flatten)]
    pub extent: Extent,
    /// Effects to add, one after the other: EFFECT, EFFECT@CYLINDER, EFFECT@pump or EFFECT@machine.
    #[arg(long, num_args = 1.., value_name = "EFFECT[@PLACE]")]
    pub add: Vec<String>,
    /// Add what a diagnosis finds, until nothing improves.
    #[arg(long)]
    pub auto: bool,
    /// With --auto: add the best proposed law if no effect of the catalogue explains the recordings.
    #[arg(long, requires = "auto")]
    pub propose: bool,
    /// Model file to write.
    #[arg(short, long, value_name = "MODEL")]
    pub output: PathBuf,
    /// Write a page with the story.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub json: Json,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

impl RefineArguments {
    /// The model that was named.
    pub fn model_choice(&self) -> ModelChoice {
        ModelChoice { model: self.model.clone().unwrap_or_default(), own: self.own.clone() }
    }

    /// The recordings that were named.
    pub fn recordings(&self) -> Recordings {
        Recordings {
            identification: self.identification.clone(),
            validation: self.validation.clone(),
            mapping: self.mapping.clone(),
            extent: self.extent,
        }
    }
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("what").required(true).multiple(true).args(["between", "parameter", "diagnosis"])))]
pub struct DesignArguments {
    #[command(flatten)]
    pub model: ModelChoice,
    /// Effects to separate, with commas: EFFECT, EFFECT@CYLINDER, EFFECT@pump, EFFECT@machine, or none for the model as it is. With
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
    #[command(flatten)]
    pub overwriting: Overwriting,
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
    pub json: Json,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

#[derive(Debug, Subcommand)]
pub enum ModelVerb {
    /// Write a commented model file for a machine of which you have the data sheet: by options, or by five questions.
    New(Box<NewModelArguments>),
    /// Read a model, try the machine, and tell which of its numbers are odd.
    Check(ModelCheckArguments),
    /// Take flow gains, dead zone and play of a valve from a static test: a table of flow against input.
    Valve(ValveTestArguments),
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
    pub json: Json,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

#[derive(Debug, Args)]
pub struct InfoArguments {
    /// Bag, or a table with a map.
    pub bag: PathBuf,
    /// Topic map (TOML); without, the map.toml in the bag's folder or FILE.map.toml beside the file, if there is one.
    #[arg(long, value_name = "MAP")]
    pub map: Option<PathBuf>,
    /// Namespace of the machine, for a bag of our own topics that has several.
    #[arg(long, value_name = "NAMESPACE", conflicts_with = "map")]
    pub namespace: Option<String>,
    #[command(flatten)]
    pub json: Json,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

#[derive(Debug, Args)]
pub struct ImportArguments {
    /// Table (.csv, .tsv, .txt, .dat, .xlsx, .mat, .parquet) or bag. Several: one recording in pieces, one after the other.
    #[arg(required = true, value_name = "DATA")]
    pub data: Vec<PathBuf>,
    /// Topic map (TOML); without, the map.toml in the bag's folder or FILE.map.toml beside the file, if there is one.
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
