//! Holds commands from one message to the next.

use excavator_model::recording::Recording;
use excavator_msgs::OrificeCommand;

use super::late_stamps::count_late;
use super::report::ReadReport;
use super::same_shape::Numbers;

/// The commands of one cylinder in the order of the bag.
#[derive(Debug)]
struct CylinderCommands {
    name: String,
    /// Stamp in ns since the epoch and area in m².
    commands: Vec<(i64, f64)>,
}

/// The commands read so far.
#[derive(Debug, Default)]
pub(super) struct CommandTrack {
    stamps: Vec<i64>,
    cylinders: Vec<CylinderCommands>,
    infinite_values: u64,
    malformed: u64,
    /// The cylinder of each area of the last message.
    named: Vec<usize>,
}

impl CommandTrack {
    /// Adds one message.
    pub fn push(&mut self, command: &OrificeCommand) {
        if command.names.len() != command.areas.len() {
            self.malformed += 1;
            self.named.clear();
            return;
        }
        self.named = command.names.iter().map(|name| self.index_of(name)).collect();
        self.push_areas(command.header.stamp.nanoseconds(), command.areas.iter().copied());
    }

    /// Adds a message that differs from the last one only in its numbers, which are the areas. `false` if there is no
    /// last message, or it was invalid: the caller must then use [`CommandTrack::push`].
    pub fn push_numbers(&mut self, numbers: Numbers) -> bool {
        if self.named.is_empty() {
            return false;
        }
        self.push_areas(numbers.stamp(), numbers.values());
        true
    }

    fn index_of(&mut self, name: &str) -> usize {
        self.cylinders.iter().position(|cylinder| cylinder.name == name).unwrap_or_else(|| {
            self.cylinders.push(CylinderCommands { name: name.to_string(), commands: Vec::new() });
            self.cylinders.len() - 1
        })
    }

    fn push_areas(&mut self, stamp: i64, areas: impl Iterator<Item = f64>) {
        self.stamps.push(stamp);
        for (&index, area) in self.named.iter().zip(areas) {
            self.infinite_values += u64::from(area.is_infinite());
            let area = if area.is_infinite() { f64::NAN } else { area };
            if let Some(cylinder) = self.cylinders.get_mut(index) {
                cylinder.commands.push((stamp, area));
            }
        }
    }

    /// A track that starts with the commands held at the end of this one.
    pub fn continued(&self) -> Self {
        let held = |own: &CylinderCommands| {
            let last = own.commands.iter().max_by_key(|(stamp, _)| *stamp).copied();
            CylinderCommands { name: own.name.clone(), commands: last.into_iter().collect() }
        };
        CommandTrack { cylinders: self.cylinders.iter().map(held).collect(), ..CommandTrack::default() }
    }

    /// Fills in the commands of the recording, whose clock in ns since the epoch is `stamps`. Each sample gets the
    /// latest command whose stamp is not after it, `NaN` before the first. Of commands with equal stamps the last one
    /// is used.
    pub fn hold(mut self, recording: &mut Recording, stamps: &[i64], report: &mut ReadReport) {
        report.infinite_values += self.infinite_values;
        report.malformed_commands += self.malformed;
        report.reordered_commands += count_late(&self.stamps);
        for commanded in &mut self.cylinders {
            let Some(cylinder) = recording.cylinders.iter_mut().find(|cylinder| cylinder.name == commanded.name) else {
                report.commands_without_cylinder.push(commanded.name.clone());
                continue;
            };
            commanded.commands.sort_by_key(|&(stamp, _)| stamp);
            let mut waiting = commanded.commands.iter().peekable();
            let mut held = f64::NAN;
            for (&now, value) in stamps.iter().zip(&mut cylinder.orifice_command) {
                while let Some(&(_, area)) = waiting.next_if(|&&(stamp, _)| stamp <= now) {
                    held = area;
                }
                *value = held;
            }
        }
    }
}
