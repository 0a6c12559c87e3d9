//! What a verdict says, and whether it is right.

use excavator_identification::decision::{Kind, Scores, Verdict};

use crate::cases::Sort;
use crate::scoring::Secret;

/// How an answer compares with the secret.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// The right verdict, and the right name alone.
    Right,
    /// The right name in a tied set.
    Tied,
    /// Some of several names, and no wrong one.
    Partial,
    /// A catalogue effect was found, and called unexplained.
    CalledUnexplained,
    /// Something is hidden, and nothing was found.
    Missed,
    /// Nothing can be seen, and something was found.
    FalseAlarm,
    /// Something was found, under a wrong name.
    WrongName,
}

impl Outcome {
    /// Name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::Right => "right",
            Outcome::Tied => "right, tied",
            Outcome::Partial => "not all",
            Outcome::WrongName => "WRONG NAME",
            Outcome::CalledUnexplained => "called unexplained",
            Outcome::Missed => "MISSED",
            Outcome::FalseAlarm => "FALSE ALARM",
        }
    }
}

/// What a verdict says.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// What is to be thought of the given model.
    pub kind: Kind,
    /// Names of the effects of each hypothesis in the set, the favoured one first.
    pub set: Vec<Vec<String>>,
    /// Whether a structural alternative forbids an attribution.
    pub is_structural: bool,
    /// Log error ratio on the validation recordings, of the given model and of the favoured hypothesis.
    pub log_error_ratios: [f64; 2],
}

impl Answer {
    /// Of a verdict on some scores.
    pub fn of(scores: &Scores, verdict: &Verdict) -> Self {
        let names = |&number: &usize| -> Vec<String> {
            scores.hypotheses[number].effects.iter().map(|effect| effect.effect.clone()).collect()
        };
        Answer {
            kind: verdict.kind,
            set: verdict.set.iter().map(names).collect(),
            is_structural: verdict.structural_alternative().is_some(),
            log_error_ratios: [0, verdict.best].map(|number| verdict.standings[number].log_error_ratio),
        }
    }

    /// Names of the favoured hypothesis.
    pub fn names(&self) -> &[String] {
        self.set.first().map_or(&[], Vec::as_slice)
    }

    /// Against the secret.
    pub fn against(&self, secret: &Secret) -> Outcome {
        let all_in = |names: &[String]| secret.effects.iter().all(|wanted| names.contains(wanted));
        let nothing_else = |names: &[String]| names.iter().all(|name| secret.effects.contains(name));
        match (secret.sort, self.kind) {
            (Sort::Nothing, Kind::Adequate) | (Sort::Unknown, Kind::Unexplained) => Outcome::Right,
            (Sort::Beside, Kind::Unexplained) if all_in(self.names()) && nothing_else(self.names()) => Outcome::Right,
            (Sort::Beside, Kind::Unexplained) if nothing_else(self.names()) => Outcome::Partial,
            (Sort::Nothing, _) => Outcome::FalseAlarm,
            (_, Kind::Adequate) => Outcome::Missed,
            (Sort::Unknown | Sort::Beside, Kind::MissingEffect) => Outcome::WrongName,
            (_, Kind::Unexplained) => Outcome::CalledUnexplained,
            _ if self.set.len() == 1 && all_in(self.names()) && nothing_else(self.names()) => Outcome::Right,
            _ if self.set.iter().any(|names| all_in(names) && nothing_else(names)) => Outcome::Tied,
            (Sort::Pair, _) if self.names().iter().any(|name| secret.effects.contains(name)) => Outcome::Partial,
            // Names of a set of several are counted one by one.
            (Sort::Several, _) if nothing_else(self.names()) => Outcome::Partial,
            _ => Outcome::WrongName,
        }
    }

    /// In one line: the verdict and the names of the set.
    pub fn words(&self) -> String {
        let set: Vec<String> = self.set.iter().map(|names| names.join(" + ")).collect();
        let set = if set.is_empty() { String::new() } else { format!(": {}", set.join(" | ")) };
        let structural = if self.is_structural { " (or how it is built)" } else { "" };
        let [before, after] = self.log_error_ratios;
        format!("{}{set}{structural}, log error ratio {before:.2} -> {after:.2}", self.kind.name())
    }
}
