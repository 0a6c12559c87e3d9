//! The motion of `up --demo`: every joint follows a sine, repeatedly.
//!
//! The bag has joint commands, which the joint controller follows in closed loop. Repeated openings would let every cylinder drift to
//! an end of its stroke, because a cylinder extends and retracts at different speeds.

use std::f64::consts::TAU;
use std::ffi::OsString;
use std::path::Path;

use excavator_bags::{topic_to_write, write_message};
use excavator_model::Model;
use excavator_model::effects::Catalogue;
use excavator_model::machine::Cylinder;
use excavator_msgs::common::JointState;
use excavator_msgs::{Header, Time};
use excavator_nodes::arm_state::joint_name;
use excavator_nodes::joint_controller::JointLaw;
use excavator_study::model_named;
use rosbag2::{BagWriter, Qos, WriteOptions};

use crate::error::VerbError;

/// Topic of the joint commands in the bag.
const TOPIC: &str = "/robot_joint_commands";
/// Duration of the motion before it repeats, on a machine of the reference size, s: several strokes of a single cylinder.
const DURATION: f64 = 60.0;
/// Joint commands per second, Hz: ten times what the controller needs, so that the motion is smooth.
const RATE: f64 = 50.0;
/// Amplitude as a share of the stroke: pistons move from 20 % to 80 % of it.
const AMPLITUDE: f64 = 0.3;
/// Highest speed as a share of the speed at which the supply can move all cylinders at once. The rest is for load and correction.
const SPEED: f64 = 0.6;

/// A bag with joint commands. It is deleted when this value is dropped.
pub(super) struct Motion {
    folder: tempfile::TempDir,
}

impl Motion {
    /// The motion of a model.
    ///
    /// # Errors
    /// [`VerbError`] for an unknown model, or one without a valve, and for a temporary folder that cannot be written.
    pub fn of(model: &str) -> Result<Self, VerbError> {
        let model = model_named(model, &Catalogue::built_in())?;
        let swings = swings(&model)?;
        let folder = tempfile::tempdir()?;
        write(&folder.path().join("motion"), &swings, duration(&model))?;
        Ok(Motion { folder })
    }

    /// The arguments of the player. The commands go to the namespace of the node.
    pub fn words(&self) -> Vec<OsString> {
        let mut words: Vec<OsString> = vec!["play".into(), self.folder.path().join("motion").into_os_string()];
        let remap = format!("{TOPIC}:={}", TOPIC.trim_start_matches('/'));
        let rest = ["--topics", TOPIC, "--remap", remap.as_str(), "--loop", "--delay", "2"];
        words.extend(rest.map(OsString::from));
        words
    }
}

fn duration(model: &Model) -> f64 {
    DURATION * model.machine.size().time()
}

/// The sine of one cylinder.
struct Swing {
    cylinder: Cylinder,
    /// Middle of the motion, m from mid-stroke.
    centre: f64,
    /// m.
    amplitude: f64,
    /// Periods in the motion. A whole number, so that the end of the motion is its beginning.
    periods: f64,
}

/// The swing of every cylinder that has a valve.
fn swings(model: &Model) -> Result<Vec<Swing>, VerbError> {
    let laws = JointLaw::of(model).map_err(VerbError::Motion)?;
    let driven: Vec<_> = model
        .machine
        .cylinders
        .iter()
        .zip(&laws)
        .filter_map(|(cylinder, law)| Some((cylinder, law.as_ref()?)))
        .collect();
    if driven.is_empty() {
        return Err(VerbError::Motion(format!("{} has no valve, so --demo cannot move it", model.machine.name)));
    }
    let share = SPEED / driven.len() as f64;
    let swings = driven.into_iter().map(|(cylinder, law)| {
        let amplitude = AMPLITUDE * cylinder.usual_travel();
        let centre = if cylinder.is_motor() { 0.0 } else { (cylinder.ends[0] + cylinder.ends[1]) / 2.0 };
        let periods = (share * law.full_speed() * duration(model) / (TAU * amplitude)).floor().max(1.0);
        Swing { cylinder: cylinder.clone(), centre, amplitude, periods }
    });
    Ok(swings.collect())
}

impl Swing {
    /// Joint position and rate at a share of the motion's duration (s).
    fn at(&self, share: f64, duration: f64) -> (f64, f64) {
        let phase = TAU * self.periods * share;
        let joint = self.cylinder.linkage.joint(self.centre + self.amplitude * phase.sin());
        let speed = self.amplitude * TAU * self.periods / duration * phase.cos();
        (joint, speed / self.cylinder.linkage.lever(joint))
    }
}

fn write(bag: &Path, swings: &[Swing], duration: f64) -> Result<(), VerbError> {
    let mut writer = BagWriter::create(bag, &WriteOptions::default())?;
    let topic = writer.add_topic(&topic_to_write::<JointState>(TOPIC, Qos::reliable(10)))?;
    let samples = (RATE * duration) as u32;
    for sample in 0..samples {
        let share = f64::from(sample) / f64::from(samples);
        let nanoseconds = (share * duration * 1e9) as u64;
        let stamp = i64::try_from(nanoseconds).ok().and_then(Time::from_nanoseconds).unwrap_or_default();
        let (position, velocity) = swings.iter().map(|swing| swing.at(share, duration)).unzip();
        let command = JointState {
            header: Header { stamp, frame_id: String::new() },
            name: swings.iter().map(|swing| joint_name(&swing.cylinder.name)).collect(),
            position,
            velocity,
            effort: Vec::new(),
        };
        write_message(&mut writer, topic, TOPIC, nanoseconds, &command)?;
    }
    writer.finish()?;
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    #[test]
    fn a_motion_stays_within_the_strokes_and_ends_where_it_began() {
        for name in ["zx30u-arm", "zx30u", "zx30u-excavator", "servo-bench"] {
            let model = built_in(name).unwrap();
            let duration = duration(&model);
            for swing in swings(&model).unwrap() {
                let ((first, _), (last, _)) = (swing.at(0.0, duration), swing.at(1.0, duration));
                assert!((first - last).abs() < 1e-9, "{name}: {}", swing.cylinder.name);
                for step in 0..=200 {
                    let (joint, rate) = swing.at(f64::from(step) / 200.0, duration);
                    assert!(joint.is_finite() && rate.is_finite(), "{name}: {}", swing.cylinder.name);
                    let at = swing.cylinder.linkage.displacement(joint);
                    assert!(!swing.cylinder.is_near_an_end(at, 0.15), "{name}: {} at {at} m", swing.cylinder.name);
                }
            }
        }
    }

    #[test]
    fn a_machine_without_a_valve_is_refused() {
        let refused = swings(&built_in("emps").unwrap()).err();
        assert!(refused.is_some_and(|error| error.to_string().contains("no valve")));
    }
}
