//! All imperfections found when reading a bag.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use rosbag2::{Damage, LostMessages, printable};

use crate::map::{Dimension, SignalName};

/// A pause in the state messages.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Gap {
    /// Time of the last sample before the gap, s after the first sample.
    pub after: f64,
    /// Time from that sample to the next, s.
    pub length: f64,
}

/// What a mapped signal measures.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MappedUnit {
    /// The signal.
    pub signal: SignalName,
    /// Unit of the numbers in the data.
    pub unit: &'static str,
    /// Dimension of the values after the scale of the map.
    pub dimension: Dimension,
}

/// What was found in a bag, and what had to be done to make a recording of it.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[non_exhaustive]
pub struct ReadReport {
    /// Messages read per topic, of all topics in the bag.
    pub messages: BTreeMap<String, u64>,
    /// State messages dropped because an earlier one has the same stamp.
    pub duplicates: u64,
    /// State messages that came after one with a later stamp; they were sorted in.
    pub reordered: u64,
    /// Commands that came after one with a later stamp; they were sorted in.
    pub reordered_commands: u64,
    /// Pauses of more than 1.5 times the median interval between state messages.
    pub gaps: Vec<Gap>,
    /// Infinite values, taken as not measured.
    pub infinite_values: u64,
    /// Entries dropped because their message has another cylinder of the same name before them.
    pub repeated_cylinders: u64,
    /// Commands dropped because they have not as many names as areas.
    pub malformed_commands: u64,
    /// Cylinders that were commanded, but appear in no state message: their commands are not in the recording.
    pub commands_without_cylinder: Vec<String>,
    /// Messages on the state and command topics that could not be decoded and were left out.
    pub undecodable: u64,
    /// The first of them: topic, number, bytes, reason.
    pub first_undecodable: Option<String>,
    /// What is wrong with the files.
    pub damage: Vec<Damage>,
    /// Time up to which data is there when the end of a file is missing: log time of the last message before the first
    /// such place, s after the first message of the bag. `None` when no end is missing.
    pub truncated_after: Option<f64>,
    /// Messages that `metadata.yaml` promises and that are not there; 0 without metadata.
    pub missing_messages: u64,
    /// Messages that were lost while the bag was recorded, as far as its recorder tells.
    pub lost: Vec<LostMessages>,
    /// Topics that the recording was made of, and the signals that were read from each; no signals for our own topics.
    #[serde(skip)]
    pub sources: BTreeMap<String, Vec<String>>,
    /// What a map or a table could not give, and where a clock was set back, one line each.
    pub notes: Vec<String>,
    /// What mapped signals measure, where the map or the data say so. Who knows the machine compares it.
    #[serde(skip)]
    pub mapped: Vec<MappedUnit>,
    /// Conditions under which a map leaves measurements out. Who knows the machine evaluates them.
    pub left_out_where: Vec<String>,
    /// First and last moment of each stretch in which a map leaves out all that a model is compared with, ns on the clock of the
    /// recording's start. The signals of cylinders are left out already; who knows the machine decides on the pump pressure.
    pub left_out: Vec<[i64; 2]>,
}

/// Maximum number of gaps in a report.
const MOST_GAPS: usize = 10_000;

impl ReadReport {
    /// Adds the findings in one block of a recording.
    pub(super) fn add_block(&mut self, block: ReadReport) {
        self.duplicates += block.duplicates;
        self.reordered += block.reordered;
        self.reordered_commands += block.reordered_commands;
        self.infinite_values += block.infinite_values;
        self.repeated_cylinders += block.repeated_cylinders;
        self.malformed_commands += block.malformed_commands;
        let room =
            MOST_GAPS.saturating_sub(self.gaps.len()).max(if self.gaps.is_empty() { block.gaps.len() } else { 0 });
        self.gaps.extend(block.gaps.into_iter().take(room));
        for name in block.commands_without_cylinder {
            if !self.commands_without_cylinder.contains(&name) {
                self.commands_without_cylinder.push(name);
            }
        }
    }

    /// Adds the findings in one of several files of a recording. Gaps are those of the whole recording.
    pub(crate) fn add_piece(&mut self, path: &Path, piece: ReadReport) {
        for (topic, count) in piece.messages.clone() {
            *self.messages.entry(topic).or_default() += count;
        }
        self.undecodable += piece.undecodable;
        self.missing_messages += piece.missing_messages;
        self.damage.extend(piece.damage.iter().cloned());
        self.lost.extend(piece.lost.iter().cloned());
        self.sources.extend(piece.sources.clone());
        self.first_undecodable = self.first_undecodable.take().or(piece.first_undecodable.clone());
        self.truncated_after = self.truncated_after.or(piece.truncated_after);
        let notes = piece.notes.iter().map(|note| format!("{}: {note}", path.display()));
        self.notes.extend(notes);
        for condition in &piece.left_out_where {
            if !self.left_out_where.contains(condition) {
                self.left_out_where.push(condition.clone());
            }
        }
        self.left_out.extend(&piece.left_out);
        for mapped in &piece.mapped {
            if !self.mapped.contains(mapped) {
                self.mapped.push(mapped.clone());
            }
        }
        self.add_block(ReadReport { gaps: Vec::new(), ..piece });
    }

    /// Bytes lost to damage, in all files.
    pub fn lost_bytes(&self) -> u64 {
        self.damage.iter().map(|damage| damage.lost_bytes).fold(0, u64::saturating_add)
    }

    /// Chunks left out because of a wrong checksum or broken content.
    pub fn bad_chunks(&self) -> usize {
        self.damage.iter().filter(|damage| matches!(damage.kind, rosbag2::DamageKind::BadChunk { .. })).count()
    }

    /// Losses of the topics that the recording was made of, one line each, with the signals that lack them.
    pub fn lost_of_sources(&self) -> Vec<String> {
        let of_source = |lost: &LostMessages| {
            let read = self.messages.get(&lost.topic).copied();
            match self.sources.get(&lost.topic) {
                Some(signals) if signals.is_empty() => Some(lost.text(read)),
                Some(signals) => Some(format!("{}, so {} has gaps", lost.text(read), signals.join(", "))),
                None => lost.topic.is_empty().then(|| lost.text(read)),
            }
        };
        self.lost.iter().filter_map(of_source).map(|line| printable(&line).into_owned()).collect()
    }

    /// One line of text for each kind of imperfection; empty for a perfect bag.
    pub fn problems(&self) -> Vec<String> {
        let mut lines: Vec<String> = self.damage.iter().map(ToString::to_string).collect();
        if let Some(time) = self.truncated_after {
            lines.push(format!("the recording is cut off: data is there up to {time:.3} s after its first message"));
        }
        let counts = [
            (self.missing_messages, "messages fewer than metadata.yaml promises"),
            (self.undecodable, "messages that could not be decoded were left out"),
            (self.duplicates, "state messages with the stamp of an earlier one were dropped"),
            (self.reordered, "state messages out of order were sorted in"),
            (self.reordered_commands, "commands out of order were sorted in"),
            (self.infinite_values, "infinite values were taken as not measured"),
            (self.repeated_cylinders, "entries for a cylinder already in the same message were dropped"),
            (self.malformed_commands, "commands without exactly one area per name were dropped"),
        ];
        lines.extend(counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")));
        lines
            .extend(self.first_undecodable.iter().map(|first| format!("the first that could not be decoded: {first}")));
        if let Some(longest) = self.gaps.iter().max_by(|a, b| a.length.total_cmp(&b.length)) {
            let Gap { after, length } = longest;
            lines.push(format!("{} gaps between samples, the longest {length:.4} s at {after:.3} s", self.gaps.len()));
        }
        if !self.commands_without_cylinder.is_empty() {
            let names = self.commands_without_cylinder.join(", ");
            lines.push(format!("commands for {names} are not used: no state message has such a cylinder"));
        }
        lines.extend(self.lost.iter().map(|lost| lost.text(self.messages.get(&lost.topic).copied())));
        lines.extend(self.notes.iter().cloned());
        lines.into_iter().map(|line| printable(&line).into_owned()).collect()
    }
}
