//! Arguments of the verbs that search for missing physics, and of those that follow a search.

use std::path::PathBuf;

use clap::Args;

use super::numbers::{positive, profile_duration, stroke_margin};
use super::{Extent, Mapping, ModelChoice, OwnEffects, Recordings, ResultFile};

#[derive(Debug, Args)]
pub struct DiagnoseArguments {
    #[command(flatten)]
    pub model: ModelChoice,
    #[command(flatten)]
    pub recordings: Recordings,
    /// Write a page with the evidence.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Save the study: recordings by name and hash, fitted models, scores and result, for refine, design and report.
    #[arg(long, value_name = "STUDY.json")]
    pub save: Option<PathBuf>,
    #[command(flatten)]
    pub result: ResultFile,
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
    pub result: ResultFile,
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["add", "auto", "diagnosis"])))]
pub struct RefineArguments {
    /// Add what this study found (`diagnose --save`), without a search: model and recordings are those of the study.
    #[arg(long, value_name = "STUDY.json", conflicts_with_all = ["model", "catalogue", "identification"])]
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
    pub result: ResultFile,
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
    /// What `diagnose --save` or `--json` wrote: tied effects, fitted values and the sensors' noise are taken from there.
    #[arg(long, value_name = "STUDY.json")]
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
    pub result: ResultFile,
}

#[derive(Debug, Args)]
pub struct ReportArguments {
    /// What `diagnose --save` wrote.
    #[arg(value_name = "STUDY.json")]
    pub study: PathBuf,
    /// Write a page with the evidence; needs the recordings of the study.
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub result: ResultFile,
}
