//! The command that comes next in the story, ready to paste.

use std::path::{Path, PathBuf};

use excavator_workbench::recording_part::Part;

use crate::cli::{Mapping, ModelChoice, Recordings};

/// Both halves of a recording of `duration` s, for a command that wants one to fit and another to judge; where `bag` is a part of a
/// recording already, the second is left to whoever pastes it.
fn halves(bag: &Path, duration: f64) -> [String; 2] {
    let is_part = matches!(Part::split(bag), Ok((_, Some(_))) | Err(_));
    if is_part {
        return [bag.display().to_string(), "ANOTHER_BAG".to_string()];
    }
    let middle = (duration / 2.0).round();
    [format!("{}@..{middle}", bag.display()), format!("{}@{middle}..", bag.display())]
}

/// A command in the making.
#[derive(Debug, Clone)]
pub struct NextStep {
    why: String,
    words: Vec<String>,
}

impl NextStep {
    /// `excavator VERB`, and what it is for: the end of a sentence that begins with "Next".
    pub fn new(why: &str, verb: &str) -> Self {
        NextStep { why: why.to_string(), words: vec!["excavator".to_string(), verb.to_string()] }
    }

    /// One more word.
    pub fn word(mut self, word: impl Into<String>) -> Self {
        self.words.push(word.into());
        self
    }

    /// An option with a path.
    pub fn path(self, option: &str, path: &Path) -> Self {
        self.word(option).word(path.display().to_string())
    }

    /// The model in `file`, with the catalogues that `choice` needs.
    pub fn model(self, file: &Path, choice: &ModelChoice) -> Self {
        let step = self.path("--model", file);
        choice.own.catalogue.iter().fold(step, |step, catalogue| step.path("--catalogue", catalogue))
    }

    /// The same model as in `choice`.
    pub fn same_model(self, choice: &ModelChoice) -> Self {
        self.model(Path::new(&choice.model), choice)
    }

    /// Where signals are found, and what of a recording counts.
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
        repeated(step, "--where", &mapping.conditions)
    }

    /// The same recordings to fit and to judge.
    pub fn recordings(self, recordings: &Recordings) -> Self {
        let paths = |step: NextStep, option: &str, bags: &[PathBuf]| {
            bags.iter().fold(step.word(option), |step, bag| step.word(bag.display().to_string()))
        };
        let step = paths(self, "--identification", &recordings.identification);
        let step = paths(step, "--validation", &recordings.validation).mapping(&recordings.mapping);
        if recordings.extent.whole { step.word("--whole") } else { step }
    }

    /// A diagnosis wants one recording to fit and another to judge: here both halves of `bag`, whose recording takes `duration` s.
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
    pub fn text(&self, width: Option<usize>) -> String {
        let command = super::paragraph::command(&self.words, width);
        format!("Next, {}:\n{command}", self.why)
    }
}
