//! Suggests the next command of the workflow, ready to paste.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use excavator_model::display::PressureUnit;
use excavator_study::recording_part::Part;

use crate::cli::{Extent, Mapping, ModelChoice, Recordings};
use crate::terminal::{command, print_fitted};

/// Both halves of a recording of `duration` s, for a command that needs one to fit and another for validation. If `bag` is
/// already a part of a recording, the user has to fill in the second.
fn halves(bag: &Path, duration: f64) -> [String; 2] {
    let is_part = matches!(Part::split(bag), Ok((_, Some(_))) | Err(_));
    if is_part {
        return [bag.display().to_string(), "ANOTHER_BAG".to_string()];
    }
    // Two digits of short recordings, whole seconds of long ones.
    let middle = duration / 2.0;
    let decimals = (1.0 - middle.log10().floor()).clamp(0.0, 6.0) as usize;
    [format!("{}@..{middle:.decimals$}", bag.display()), format!("{}@{middle:.decimals$}..", bag.display())]
}

/// A command under construction.
#[derive(Debug, Clone)]
pub struct NextStep {
    why: String,
    words: Vec<String>,
}

impl NextStep {
    /// `excavator VERB` and its purpose: the end of a sentence that begins with "Next".
    pub fn new(why: &str, verb: &str) -> Self {
        NextStep { why: why.to_string(), words: vec!["excavator".to_string(), verb.to_string()] }
    }

    /// Adds one word.
    pub fn word(mut self, word: impl Into<String>) -> Self {
        self.words.push(word.into());
        self
    }

    /// Adds an option with a path.
    pub fn path(self, option: &str, path: &Path) -> Self {
        self.word(option).word(path.display().to_string())
    }

    /// Adds an option with a file to write: `name`, or the next free name with a number, since no output replaces a file.
    pub fn new_file(self, option: &str, name: &str) -> Self {
        self.path(option, &free(Path::new(name)))
    }

    /// Adds the model in `file`, with the catalogues that `choice` needs.
    pub fn model(self, file: &Path, choice: &ModelChoice) -> Self {
        let step = self.path("--model", file);
        choice.own.catalogue.iter().fold(step, |step, catalogue| step.path("--catalogue", catalogue))
    }

    /// Adds the model of `choice`.
    pub fn same_model(self, choice: &ModelChoice) -> Self {
        self.model(Path::new(&choice.model), choice)
    }

    /// Adds the options for the sources of signals and for the samples that count.
    pub fn mapping(mut self, mapping: &Mapping) -> Self {
        if let Some(map) = &mapping.map {
            self = self.path("--map", map);
        }
        if let Some(namespace) = &mapping.namespace {
            self = self.word("--namespace").word(namespace.as_str());
        }
        let repeated = |step: NextStep, option: &str, words: &[String]| {
            words.iter().fold(step, |step, word| step.word(option).word(word.as_str()))
        };
        let step = repeated(self, "--accept", &mapping.accept);
        let step = repeated(step, "--where", &mapping.conditions);
        if mapping.leave_out_stops { step.word("--leave-out-stops") } else { step }
    }

    /// Adds `--whole`, if all of a long recording is used.
    pub fn extent(self, extent: Extent) -> Self {
        if extent.whole { self.word("--whole") } else { self }
    }

    /// Adds the same recordings for the fit and for validation.
    pub fn recordings(self, recordings: &Recordings) -> Self {
        let paths = |step: NextStep, option: &str, bags: &[PathBuf]| {
            bags.iter().fold(step.word(option), |step, bag| step.word(bag.display().to_string()))
        };
        let step = paths(self, "--identification", &recordings.identification);
        paths(step, "--validation", &recordings.validation).mapping(&recordings.mapping).extent(recordings.extent)
    }

    /// A diagnosis needs one recording for the fit and another for validation: here both halves of `bag`, which is `duration` s
    /// long.
    pub fn diagnosis_of_halves(why: &str, model: &ModelChoice, bag: &Path, duration: f64, mapping: &Mapping) -> Self {
        let [fitted, judged] = halves(bag, duration);
        NextStep::new(why, "diagnose")
            .same_model(model)
            .word("--identification")
            .word(fitted)
            .word("--validation")
            .word(judged)
            .mapping(mapping)
    }

    /// The sentence and the command.
    fn text(&self, width: Option<usize>) -> String {
        let mut words = self.words.clone();
        if PressureUnit::shown() != PressureUnit::default() {
            words.extend(["--units".to_string(), PressureUnit::shown().symbol().to_string()]);
        }
        format!("Next, {}:\n{}", self.why, command(&words, width))
    }
}

/// `path` if nothing is there, else the first of `NAME-2`, `NAME-3`, ... that is free.
pub fn free(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let extension = path.extension().map_or(String::new(), |extension| format!(".{}", extension.to_string_lossy()));
    let numbered = (2..).map(|number: usize| path.with_file_name(format!("{stem}-{number}{extension}")));
    let mut all = std::iter::once(path.to_path_buf()).chain(numbered);
    all.find(|path| path.symlink_metadata().is_err()).unwrap_or_default()
}

/// Whether no next command is printed, because it follows by itself.
static FOLLOWS: AtomicBool = AtomicBool::new(false);

/// Stops the printing of next commands, for steps that follow each other by themselves, or begins it again.
pub fn steps_follow(follow: bool) {
    FOLLOWS.store(follow, Ordering::Relaxed);
}

/// Prints the suggested next command.
pub fn print_next(step: &NextStep) {
    if !FOLLOWS.load(Ordering::Relaxed) {
        print_fitted(|width| step.text(width));
    }
}
