//! Arguments that several verbs share.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use excavator_bags::map::Origin;
use excavator_identification::checks::OVERRULABLE;
use excavator_model::Model;
use excavator_study::preparation::Preparation;
use excavator_study::recordings::Use;
use excavator_study::{Study, WorkError};

use crate::terminal::remark;

#[derive(Debug, Default, Clone, Copy, Args)]
pub struct Overwriting {
    /// Replace files that exist; never one that this command reads.
    #[arg(long)]
    pub force: bool,
}

/// Where the result of a verb goes.
#[derive(Debug, Default, Clone, Args)]
pub struct ResultFile {
    /// Write the result as JSON to this file ("-": standard output, instead of the table).
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

impl ResultFile {
    /// The output of `--json`, as it is checked.
    pub fn output(&self) -> (&'static str, Option<&Path>) {
        ("--json", self.json.as_deref())
    }

    /// Whether standard output is for people: not where it takes the JSON.
    pub fn is_shown(&self) -> bool {
        self.json.as_deref() != Some(Path::new("-"))
    }
}

#[derive(Debug, Default, Clone, Args)]
pub struct Mapping {
    /// Topic map (TOML), or `opera`; without, the map.toml in the bag's folder or FILE.map.toml beside the file, if there is one.
    #[arg(long, value_name = "MAP")]
    pub map: Option<PathBuf>,
    /// Namespace of the machine, for a bag of our own topics, or of OPERA's, that has several.
    #[arg(long, value_name = "NAMESPACE")]
    pub namespace: Option<String>,
    /// Use a recording although this check refuses it; the refusal says its name. Repeat it for several.
    #[arg(long, value_name = "CHECK", value_parser = PossibleValuesParser::new(OVERRULABLE), hide_possible_values = true)]
    pub accept: Vec<String>,
    /// Compare only where this formula holds, as in "abs(v) > 0.002" (SI units). The rest is simulated, not compared. Repeat to
    /// combine.
    #[arg(long = "where", value_name = "CONDITION")]
    pub conditions: Vec<String>,
    /// Leave out the time that a piston spends at a stop: its contact is stiff, and shows nothing of the drive.
    #[arg(long)]
    pub leave_out_stops: bool,
}

impl Mapping {
    /// Where signals are found.
    pub fn origin(&self) -> Origin<'_> {
        Origin { map: self.map.as_deref(), namespace: self.namespace.as_deref() }
    }

    /// How recordings are read and made fit for use. Remarks go to standard error.
    pub fn preparation(&self, extent: Extent) -> Preparation<'_> {
        let usage = Use { accept: &self.accept, conditions: &self.conditions, leaves_out_stops: self.leave_out_stops };
        Preparation { origin: self.origin(), usage, whole: extent.whole, remark: &remark }
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

    /// A study of these recordings.
    ///
    /// # Errors
    /// [`WorkError`] if one cannot be read, or if a check refuses it.
    pub fn study(&self, model: Model) -> Result<Study, WorkError> {
        self.mapping.preparation(self.extent).study(model, [&self.identification, &self.validation])
    }
}
