//! Writes a recording as a bag.

use std::path::Path;

use excavator_model::recording::Recording;
use excavator_msgs::{ArmState, CylinderState, Header, OrificeCommand, Time};
use rosbag2::{BagWriter, Qos, Staging, WriteOptions};

use crate::{BagError, Topics, topic_to_write, write_message};

/// Depth of the offered history of `/arm/state`.
const STATE_DEPTH: u32 = 50;
/// Depth of the offered history of `/arm/orifice_command`.
const COMMAND_DEPTH: u32 = 10;

/// Writes a recording as a new rosbag2 folder: a state message for each sample, and a command message for the first
/// sample and at each change of a command, with the changed cylinders only. All stamps are those of the samples, to the
/// nearest nanosecond. The folder gets its name only when the bag is complete.
///
/// ```
/// use excavator_bags::{Topics, read_recording, write_recording};
/// use excavator_model::recording::Recording;
/// use rosbag2::WriteOptions;
///
/// let folder = tempfile::tempdir()?;
/// let bag = folder.path().join("drive_1");
/// let time: Vec<f64> = (0..100).map(|sample| f64::from(sample) * 0.01).collect();
/// let mut recording = Recording::unmeasured("a drive", time, &["arm"]);
/// recording.start_nanoseconds = 1_790_000_000_000_000_000;
/// recording.cylinders[0].cap_pressure.fill(12.4e6);
/// write_recording(&bag, &recording, &Topics::default(), &WriteOptions::default())?;
///
/// let (read, _) = read_recording(&bag, &Topics::default())?;
/// assert_eq!(read.cylinders[0].cap_pressure, recording.cylinders[0].cap_pressure);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`BagError::InvalidRecording`], [`BagError::StampOutOfRange`], [`BagError::StampsCoincide`], [`rosbag2::Error::AlreadyExists`]
/// and [`rosbag2::Error::NotReplaceable`] before anything is written; then all of [`BagWriter`].
pub fn write_recording(
    path: &Path,
    recording: &Recording,
    topics: &Topics,
    options: &WriteOptions,
) -> Result<(), BagError> {
    recording.validate()?;
    let stamps = stamps(recording)?;
    let staging = Staging::beside(path, options.replace)?;
    write_samples(staging.folder(), recording, &stamps, topics, options).map_err(|error| match error {
        BagError::Bag(error) => staging.named(error).into(),
        other => other,
    })?;
    staging.put_in_place()?;
    Ok(())
}

fn write_samples(
    folder: &Path,
    recording: &Recording,
    stamps: &[Stamp],
    topics: &Topics,
    options: &WriteOptions,
) -> Result<(), BagError> {
    let mut bag = BagWriter::create(folder, options)?;
    let states = bag.add_topic(&topic_to_write::<ArmState>(&topics.state, Qos::reliable(STATE_DEPTH)))?;
    let commands = bag.add_topic(&topic_to_write::<OrificeCommand>(&topics.command, Qos::reliable(COMMAND_DEPTH)))?;
    for (sample, &Stamp { time, nanoseconds }) in stamps.iter().enumerate() {
        if let Some(command) = command_at(recording, sample, time) {
            write_message(&mut bag, commands, &topics.command, nanoseconds, &command)?;
        }
        write_message(&mut bag, states, &topics.state, nanoseconds, &state_at(recording, sample, time))?;
    }
    bag.finish()?;
    Ok(())
}

/// The stamp of a sample in the two formats that a bag needs.
struct Stamp {
    time: Time,
    nanoseconds: u64,
}

fn stamps(recording: &Recording) -> Result<Vec<Stamp>, BagError> {
    let mut stamps: Vec<Stamp> = Vec::with_capacity(recording.len());
    for (index, seconds) in recording.time.iter().enumerate() {
        let nanoseconds = recording.start_nanoseconds.saturating_add((seconds * 1e9).round() as i64);
        let (Some(time), Ok(unsigned)) = (Time::from_nanoseconds(nanoseconds), u64::try_from(nanoseconds)) else {
            return Err(BagError::StampOutOfRange { index, nanoseconds });
        };
        if stamps.last().is_some_and(|previous| previous.nanoseconds == unsigned) {
            return Err(BagError::StampsCoincide { index, nanoseconds });
        }
        stamps.push(Stamp { time, nanoseconds: unsigned });
    }
    Ok(stamps)
}

fn header(stamp: Time) -> Header {
    Header { stamp, frame_id: String::new() }
}

fn state_at(recording: &Recording, sample: usize, stamp: Time) -> ArmState {
    let cylinders = recording
        .cylinders
        .iter()
        .map(|cylinder| CylinderState {
            name: cylinder.name.clone(),
            joint_angle: cylinder.joint_angle[sample],
            displacement: cylinder.displacement[sample],
            velocity: cylinder.velocity[sample],
            cap_pressure: cylinder.cap_pressure[sample],
            rod_pressure: cylinder.rod_pressure[sample],
            orifice_area: cylinder.orifice_area[sample],
            rod_force: cylinder.rod_force[sample],
        })
        .collect();
    ArmState {
        header: header(stamp),
        cylinders,
        pump_pressure: recording.pump_pressure[sample],
        tank_pressure: recording.tank_pressure[sample],
        pump_flow: recording.pump_flow[sample],
        oil_temperature: recording.oil_temperature[sample],
    }
}

/// The cylinders whose command differs from the previous sample; at the first sample, those that have a command. The
/// end of a command (`NaN` after a number) is also written, otherwise the command would be held.
fn command_at(recording: &Recording, sample: usize, stamp: Time) -> Option<OrificeCommand> {
    let mut command = OrificeCommand { header: header(stamp), names: Vec::new(), areas: Vec::new() };
    for cylinder in &recording.cylinders {
        let area = cylinder.orifice_command[sample];
        let before = sample.checked_sub(1).map_or(f64::NAN, |before| cylinder.orifice_command[before]);
        let unchanged = area.to_bits() == before.to_bits() || (area.is_nan() && before.is_nan());
        if !unchanged {
            command.names.push(cylinder.name.clone());
            command.areas.push(area);
        }
    }
    (!command.names.is_empty()).then_some(command)
}
