//! Stored scores, judged again: a change of a rule is seen on every machine ever asked, without a fit.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use excavator_identification::decision::{Hypothesis, Policy, Scores, ScoresError, decide};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::answer::{Answer, Outcome};
use crate::cases::Sort;
use crate::reliability::{diagram, reliability, table};
use crate::scoring::Secret;

/// The scores of one machine, and what it hides.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Stored {
    /// Who made the machine, and its number.
    pub source: String,
    /// What it hides.
    pub secret: Secret,
    /// The scores of its diagnosis.
    pub scores: Scores,
}

/// Why scores cannot be stored or read.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// A file or folder.
    #[error("{}: {source}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Not what this program stored.
    #[error("{}: {source}", path.display())]
    Json {
        /// Which.
        path: PathBuf,
        /// Why.
        source: serde_json::Error,
    },
    /// Scores of another version.
    #[error("{}: {source}", path.display())]
    Scores {
        /// Which.
        path: PathBuf,
        /// Why.
        source: ScoresError,
    },
}

/// Hypotheses that are kept for being among the best, admissible or not.
const KEPT: usize = 6;

/// Level of compression: scores are written once and read often.
const LEVEL: i32 = 19;

impl Stored {
    /// Writes it into a folder, as its source says.
    ///
    /// # Errors
    /// [`ReplayError`].
    pub fn write(&self, folder: &Path) -> Result<PathBuf, ReplayError> {
        let path = folder.join(format!("{}.json.zst", self.source));
        let failed = |source| ReplayError::File { path: path.clone(), source };
        let json = serde_json::to_vec(self).map_err(|source| ReplayError::Json { path: path.clone(), source })?;
        std::fs::create_dir_all(folder).map_err(failed)?;
        std::fs::write(&path, zstd::encode_all(json.as_slice(), LEVEL).map_err(failed)?).map_err(failed)?;
        Ok(path)
    }

    /// Without the hypotheses that no rule would look at again: those that are neither admissible under the usual policy, nor structural, nor a
    /// part of an admissible one, nor among the best few.
    pub fn thinned(mut self) -> Self {
        let verdict = decide(&self.scores, &Policy::default());
        let all = &self.scores.hypotheses;
        let mut ranked: Vec<usize> = (1..all.len()).collect();
        let ratio = |number: &usize| verdict.standings[*number].log_error_ratio;
        ranked.sort_by(|a, b| ratio(a).total_cmp(&ratio(b)));
        ranked.truncate(KEPT);
        let is_part = |one: &Hypothesis| {
            all.iter().zip(&verdict.standings).any(|(more, standing)| standing.is_admissible && more.extends(one))
        };
        let kept: Vec<Hypothesis> = (0..all.len())
            .filter(|&number| {
                number == 0
                    || verdict.standings[number].is_admissible
                    || ranked.contains(&number)
                    || all[number].is_structural()
                    || is_part(&all[number])
            })
            .map(|number| all[number].clone())
            .collect();
        self.scores.hypotheses = kept;
        self
    }

    /// Reads one.
    ///
    /// # Errors
    /// [`ReplayError`].
    pub fn read(path: &Path) -> Result<Self, ReplayError> {
        let failed = |source| ReplayError::File { path: path.to_path_buf(), source };
        let json = zstd::decode_all(std::fs::File::open(path).map_err(failed)?).map_err(failed)?;
        let stored: Stored =
            serde_json::from_slice(&json).map_err(|source| ReplayError::Json { path: path.to_path_buf(), source })?;
        let scores =
            stored.scores.checked().map_err(|source| ReplayError::Scores { path: path.to_path_buf(), source })?;
        Ok(Stored { scores, ..stored })
    }

    /// All of a folder, by name.
    ///
    /// # Errors
    /// [`ReplayError`].
    pub fn read_all(folder: &Path) -> Result<Vec<Self>, ReplayError> {
        let failed = |source| ReplayError::File { path: folder.to_path_buf(), source };
        let mut paths = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.extension().is_some_and(|extension| extension == "zst") {
                paths.push(path);
            }
        }
        paths.sort();
        paths.iter().map(|path| Stored::read(path)).collect()
    }

    /// The answer under a policy.
    pub fn answer(&self, policy: &Policy) -> Answer {
        Answer::of(&self.scores, &decide(&self.scores, policy))
    }
}

/// Judges all scores of some folders: a line for each machine whose answer is not right, a summary, and what changed against an
/// earlier replay whose file is given (written where it does not exist). A diagram of the stated probabilities goes to a file.
///
/// # Errors
/// [`ReplayError`].
pub fn replayed(folders: &[PathBuf], against: Option<&Path>, to: Option<&Path>) -> Result<String, ReplayError> {
    let mut stored = Vec::new();
    for folder in folders {
        stored.extend(Stored::read_all(folder)?);
    }
    let policy = Policy::default();
    let begin = Instant::now();
    let answers: Vec<(String, Outcome, String, Group)> = stored
        .par_iter()
        .map(|one| {
            let answer = one.answer(&policy);
            (one.source.clone(), answer.against(&one.secret), answer.words(), group_of(&one.secret))
        })
        .collect();
    let seconds = begin.elapsed().as_secs_f64();
    let mut lines: Vec<String> = answers
        .iter()
        .filter(|(_, outcome, ..)| *outcome != Outcome::Right)
        .map(|(source, outcome, words, _)| format!("{source:60} {:18} {words}", outcome.name()))
        .collect();
    lines.push(summary(&answers));
    let bins = reliability(&stored, &policy);
    lines.push(table(&bins));
    if let Some(path) = to {
        std::fs::write(path, diagram(&bins))
            .map_err(|source| ReplayError::File { path: path.to_path_buf(), source })?;
    }
    lines.push(format!("{} machines judged in {seconds:.1} s", answers.len()));
    if let Some(path) = against {
        lines.push(changes(&answers, path)?);
    }
    Ok(lines.join("\n"))
}

/// Sort and strength of a secret.
type Group = (Sort, String);

fn group_of(secret: &Secret) -> Group {
    let strength = secret.words.rsplit(' ').next().unwrap_or_default();
    (secret.sort, if secret.sort == Sort::Nothing { String::new() } else { strength.to_string() })
}

fn summary(answers: &[(String, Outcome, String, Group)]) -> String {
    let mut counts: BTreeMap<&Group, BTreeMap<Outcome, usize>> = BTreeMap::new();
    for (_, outcome, _, group) in answers {
        *counts.entry(group).or_default().entry(*outcome).or_default() += 1;
    }
    let line = |((sort, strength), outcomes): (&Group, BTreeMap<Outcome, usize>)| {
        let total: usize = outcomes.values().sum();
        let each: Vec<String> = outcomes.iter().map(|(outcome, count)| format!("{count} {}", outcome.name())).collect();
        format!("{:20} {total:>4}: {}", format!("{sort:?} {strength}"), each.join(", "))
    };
    counts.into_iter().map(line).collect::<Vec<_>>().join("\n")
}

/// What is another outcome than in the file, which is written anew.
fn changes(answers: &[(String, Outcome, String, Group)], path: &Path) -> Result<String, ReplayError> {
    let failed = |source| ReplayError::File { path: path.to_path_buf(), source };
    let before = if path.exists() { std::fs::read_to_string(path).map_err(failed)? } else { String::new() };
    let before: BTreeMap<&str, &str> = before.lines().filter_map(|line| line.split_once('\t')).collect();
    let is_other = |source: &str, outcome: Outcome| before.get(source).is_some_and(|was| *was != outcome.name());
    let changed: Vec<String> = answers
        .iter()
        .filter(|(source, outcome, ..)| is_other(source, *outcome))
        .map(|(source, outcome, words, _)| {
            let was = before.get(source.as_str()).copied().unwrap_or_default();
            format!("  {source}: {was} -> {} ({words})", outcome.name())
        })
        .collect();
    let now: Vec<String> =
        answers.iter().map(|(source, outcome, ..)| format!("{source}\t{}", outcome.name())).collect();
    std::fs::write(path, now.join("\n") + "\n").map_err(failed)?;
    Ok(format!("{} outcomes changed\n{}", changed.len(), changed.join("\n")))
}
