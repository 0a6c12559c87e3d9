//! Commands, held from one message to the next.

use excavator_model::recording::Recording;
use excavator_msgs::OrificeCommand;

use super::late_stamps::count_late;
use super::report::ReadReport;

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
}

impl CommandTrack {
    /// Adds one message.
    pub fn push(&mut self, command: &OrificeCommand) {
        if command.names.len() != command.areas.len() {
            self.malformed += 1;
            return;
        }
        let stamp = command.header.stamp.nanoseconds();
        self.stamps.push(stamp);
        for (name, &area) in command.names.iter().zip(&command.areas) {
            let area = if area.is_infinite() {
                self.infinite_values += 1;
                f64::NAN
            } else {
                area
            };
            match self.cylinders.iter_mut().find(|cylinder| cylinder.name == *name) {
                Some(cylinder) => cylinder.commands.push((stamp, area)),
                None => self.cylinders.push(CylinderCommands { name: name.clone(), commands: vec![(stamp, area)] }),
            }
        }
    }

    /// A track that begins with the commands that are held at the end of this one.
    pub fn continued(&self) -> Self {
        let held = |own: &CylinderCommands| {
            let last = own.commands.iter().max_by_key(|(stamp, _)| *stamp).copied();
            CylinderCommands { name: own.name.clone(), commands: last.into_iter().collect() }
        };
        CommandTrack { cylinders: self.cylinders.iter().map(held).collect(), ..CommandTrack::default() }
    }

    /// Fills in the commands of the recording, whose clock in ns since the epoch is `stamps`: at each sample the
    /// latest command with a stamp not after it, `NaN` before the first. Of commands with equal stamps the last counts.
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
