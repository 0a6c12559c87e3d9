//! The built-in map `opera`: a log, a bag of frames and bags of topics of the same machine, and what gateways and simulators make up.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::support::{Frame, header};
use excavator_bags::ReadReport;
use excavator_bags::map::{OPERA, Origin, read_recording_or_mapped};
use excavator_model::document::built_in;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use excavator_model::simulation::Plant;
use excavator_msgs::Header;
use excavator_msgs::common::JointState;
use rosbag2::{BagWriter, TopicToWrite, WriteOptions, cdr};
use serde::Serialize;

const MS: i64 = 1_000_000;
const START: i64 = 1_790_000_000_000_000_000;
/// 60 s at 100 Hz.
const SAMPLES: usize = 6000;
const AXES: [&str; 4] = ["swing", "boom", "arm", "bucket"];
/// Steps of the frames: rad, MPa, MPa.
const STEPS: [f64; 3] = [0.0004, 0.2, 0.02];

/// Readings of one moment: angle in rad; pressures of both chambers and of both pilots in MPa.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Axis {
    angle: f64,
    main: [f64; 2],
    pilot: [f64; 2],
}

type Shot = [Axis; 4];

/// A minute of a simulated excavator, in the steps of COM3's frames.
fn shots() -> &'static [Shot] {
    static SHOTS: OnceLock<Vec<Shot>> = OnceLock::new();
    SHOTS.get_or_init(|| {
        let model = built_in("zx30u-excavator").unwrap();
        let system = System::new(&model);
        let mut plant = Plant::new(&system, &[0.0; 4], 0.01, None).unwrap();
        let step = |value: f64, step: f64| (value / step).round() * step;
        let shot = |index: usize| {
            let time = index as f64 * 0.01;
            let waves: [f64; 4] =
                std::array::from_fn(|axis| (0.4 * (1.0 + 0.37 * axis as f64) * time + axis as f64).sin());
            // Too little for the valve to open around the null.
            let areas = waves.map(|wave| 6e-5 * wave.signum() * (wave.abs() - 0.3).max(0.0));
            plant.step(&areas).unwrap();
            let sample = plant.sample();
            std::array::from_fn(|axis| {
                let signals = &sample.cylinders[axis];
                let pilot = |wave: f64| if wave > 0.05 { step(0.4 + 2.5 * wave, STEPS[2]) } else { 0.0 };
                Axis {
                    // The counter of the swing starts anew after a turn.
                    angle: step((signals.joint_angle + 9.0).rem_euclid(18.0) - 9.0, STEPS[0]),
                    main: [signals.cap_pressure, signals.rod_pressure].map(|p| step(1e-6 * p, STEPS[1])),
                    pilot: [pilot(waves[axis]), pilot(-waves[axis])],
                }
            })
        };
        (0..SAMPLES).map(shot).collect()
    })
}

fn stamp(index: usize) -> i64 {
    START + 10 * MS * index as i64
}

/// The frames of a moment, from the machine's address: identifier and data.
fn frames(shot: &Shot, index: usize) -> Vec<(u32, [u8; 8])> {
    let [swing, boom, arm, bucket] = shot;
    let mut angles = [0; 8];
    for (place, axis) in [boom, arm, bucket, swing].into_iter().enumerate() {
        let raw = ((axis.angle + 10.0) / STEPS[0]).round() as u16;
        angles[2 * place..2 * place + 2].copy_from_slice(&raw.to_le_bytes());
    }
    let bytes = |values: [[f64; 2]; 4], step: f64, least: f64| {
        let flat = values.as_flattened().iter().map(|value| ((value - least) / step).round() as u8);
        <[u8; 8]>::try_from(flat.collect::<Vec<u8>>()).unwrap()
    };
    let order = [boom, arm, bucket, swing];
    let mut all = vec![
        (0x18ff_7de8, angles),
        (0x18ff_79e8, bytes(order.map(|axis| axis.main), STEPS[1], -10.0)),
        (0x18ff_7be8, bytes(order.map(|axis| axis.pilot), STEPS[2], 0.0)),
    ];
    if index.is_multiple_of(5) {
        all.push((0x18ff_84e8, [0, 0, 0, 145, 0, 0, 0, 0]));
    }
    all
}

#[derive(Serialize)]
struct FluidPressure {
    header: Header,
    fluid_pressure: f64,
    variance: f64,
}

#[derive(Serialize)]
struct Dimension {
    label: String,
    size: u32,
    stride: u32,
}

#[derive(Serialize)]
struct Float64MultiArray {
    dim: Vec<Dimension>,
    data_offset: u32,
    data: Vec<f64>,
}

/// Folder with the forms of one recording.
struct Forms {
    folder: tempfile::TempDir,
}

fn topic(bag: &mut BagWriter, name: &str, type_name: &str) -> rosbag2::TopicId {
    let (name, type_name) = (name.to_string(), type_name.to_string());
    bag.add_topic(&TopicToWrite { name, type_name, schema: String::new(), qos: Vec::new() }).unwrap()
}

impl Forms {
    fn new() -> Forms {
        Forms { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A log of candump; `change` may add or replace frames.
    fn log(&self, shots: &[Shot], change: impl Fn(usize, &mut Vec<(u32, [u8; 8])>)) -> PathBuf {
        let mut text = String::new();
        for (index, shot) in shots.iter().enumerate() {
            let mut frames = frames(shot, index);
            change(index, &mut frames);
            let micros = stamp(index) / 1000;
            for (id, data) in frames {
                let hex: String = data.iter().map(|byte| format!("{byte:02X}")).collect();
                writeln!(text, "({}.{:06}) can0 {id:08X}#{hex}", micros / 1_000_000, micros % 1_000_000).unwrap();
            }
        }
        let path = self.path("can0.log");
        std::fs::write(&path, text).unwrap();
        path
    }

    fn frames(&self, shots: &[Shot]) -> PathBuf {
        let path = self.path("frames");
        let mut bag = BagWriter::create(&path, &WriteOptions::default()).unwrap();
        let id = topic(&mut bag, "/from_can_bus", "can_msgs/msg/Frame");
        for (index, shot) in shots.iter().enumerate() {
            let at = stamp(index);
            for (number, data) in frames(shot, index) {
                let header = header(at);
                let frame =
                    Frame { header, id: number, is_rtr: false, is_extended: true, is_error: false, dlc: 8, data };
                bag.write(id, at as u64, at as u64, &cdr::encode(&frame).unwrap()).unwrap();
            }
        }
        bag.finish().unwrap();
        path
    }

    /// Topics as the machine and its simulators publish them: names in frames, stamps in the elements, in Pa.
    fn topics(&self, shots: &[Shot], joints: &str) -> PathBuf {
        let path = self.path("topics");
        let mut bag = BagWriter::create(&path, &WriteOptions::default()).unwrap();
        let state = topic(&mut bag, joints, "sensor_msgs/msg/JointState");
        let parent = joints.rsplit_once('/').unwrap().0;
        let array = "com3_msgs/msg/FluidPressureArray";
        let [main, pilot] =
            ["main", "pilot"].map(|kind| topic(&mut bag, &format!("{parent}/{kind}_fluid_pressure"), array));
        for (index, shot) in shots.iter().enumerate() {
            let at = stamp(index);
            // Messages are logged later than they are stamped.
            let log = (at + 3 * MS) as u64;
            bag.write(state, log, log, &cdr::encode(&joint_state(shot, at)).unwrap()).unwrap();
            for (id, kind) in [(main, "main"), (pilot, "pilot")] {
                let names = names(&format!("_{kind}_pressure"), "crowed");
                let values = shot.map(|axis| if kind == "main" { axis.main } else { axis.pilot });
                let pressures = names.iter().zip(values.as_flattened()).map(|(name, value)| FluidPressure {
                    header: Header { frame_id: name.clone(), ..header(at) },
                    fluid_pressure: 1e6 * value,
                    variance: 0.0,
                });
                let bytes = cdr::encode(&(pressures.collect::<Vec<_>>(),)).unwrap();
                bag.write(id, log, log, &bytes).unwrap();
            }
        }
        bag.finish().unwrap();
        path
    }

    /// Topics of a public gateway: arrays in MPa without stamps, names in their dimensions; with `also`, tracks on the same topic.
    fn gateway(&self, shots: &[Shot], also: bool) -> PathBuf {
        let path = self.path("gateway");
        let mut bag = BagWriter::create(&path, &WriteOptions::default()).unwrap();
        let state = topic(&mut bag, "/joint_state", "sensor_msgs/msg/JointState");
        let [main, pilot] = ["main", "pi"]
            .map(|kind| topic(&mut bag, &format!("/{kind}_pressure_1"), "std_msgs/msg/Float64MultiArray"));
        let chambers: Vec<String> = AXES.iter().flat_map(|axis| chamber_names(axis)).collect();
        let array = |names: &[String], data: &[f64]| {
            let dim = names.iter().map(|label| Dimension { label: label.clone(), size: 0, stride: 0 }).collect();
            cdr::encode(&Float64MultiArray { dim, data_offset: 0, data: data.to_vec() }).unwrap()
        };
        for (index, shot) in shots.iter().enumerate() {
            let at = stamp(index) as u64;
            bag.write(state, at, at, &cdr::encode(&joint_state(shot, stamp(index))).unwrap()).unwrap();
            bag.write(main, at, at, &array(&chambers, shot.map(|axis| axis.main).as_flattened())).unwrap();
            let names = names("_pilot_pressure", "crowd");
            bag.write(pilot, at, at, &array(&names, shot.map(|axis| axis.pilot).as_flattened())).unwrap();
            if also {
                let tracks = ["right_track_motor_a_pressure".to_string(), "right_track_motor_b_pressure".to_string()];
                bag.write(main, at, at, &array(&tracks, &[1.0, 2.0])).unwrap();
            }
        }
        bag.finish().unwrap();
        path
    }
}

/// Names of both directions of all axes, in the order of [`AXES`].
fn names(end: &str, crowd: &str) -> Vec<String> {
    let sides = [["right", "left"], ["up", "down"], [crowd, "dump"], [crowd, "dump"]];
    AXES.iter().zip(sides).flat_map(|(axis, sides)| sides.map(|side| format!("{axis}_{side}{end}"))).collect()
}

fn chamber_names(axis: &str) -> [String; 2] {
    let sides = if axis == "swing" { ["motor_a", "motor_b"] } else { ["cylinder_bottom", "cylinder_rod"] };
    sides.map(|side| format!("{axis}_{side}_pressure"))
}

/// In another order than that of the axes, with a joint that no cylinder drives.
fn joint_state(shot: &Shot, at: i64) -> JointState {
    let order = [3, 2, 1, 0];
    let mut name: Vec<String> = order.iter().map(|&axis| format!("{}_joint", AXES[axis])).collect();
    let mut position: Vec<f64> = order.iter().map(|&axis| shot[axis].angle).collect();
    name.insert(1, "bucket_end_joint".to_string());
    position.insert(1, 0.7);
    JointState { header: header(at), name, position, velocity: Vec::new(), effort: Vec::new() }
}

fn read(path: &Path) -> (Recording, ReadReport) {
    read_recording_or_mapped(path, Origin { map: Some(Path::new(OPERA)), namespace: None }).unwrap()
}

#[track_caller]
fn assert_state(found: &Recording, shots: &[Shot]) {
    assert_eq!(found.len(), shots.len());
    assert_eq!(found.start_nanoseconds, START);
    let near = |name: &str, index: usize, value: f64, expected: f64, step: f64| {
        assert!((value - expected).abs() <= 0.51 * step, "{name} at {index}: {value}, not {expected}");
    };
    for (axis, name) in AXES.iter().enumerate() {
        let signals = found.cylinder(name).unwrap();
        for (index, shot) in shots.iter().enumerate() {
            let Axis { angle, main, pilot } = shot[axis];
            near(name, index, signals.joint_angle[index], angle, STEPS[0]);
            near(name, index, 1e-6 * signals.cap_pressure[index], main[0], STEPS[1]);
            near(name, index, 1e-6 * signals.rod_pressure[index], main[1], STEPS[1]);
            near(name, index, 1e-6 * signals.orifice_command[index], pilot[0] - pilot[1], STEPS[2]);
        }
    }
}

#[test]
fn every_form_of_a_minute_gives_the_same_state() {
    let (forms, shots) = (Forms::new(), shots());
    let log = forms.log(shots, |_, _| {});
    for path in [log, forms.frames(shots), forms.topics(shots, "/zx200/joint_states"), forms.gateway(shots, false)] {
        let (recording, report) = read(&path);
        assert_state(&recording, shots);
        assert_eq!(report.problems(), [""; 0], "{}", path.display());
    }
    let (recording, _) = read(&forms.path("can0.log"));
    assert!(recording.oil_temperature.iter().filter(|value| value.is_finite()).all(|value| *value == 45.0));
}

#[test]
fn of_two_senders_the_first_stays_and_the_other_is_counted() {
    let (forms, shots) = (Forms::new(), &shots()[..500]);
    let log = forms.log(shots, |index, frames| {
        // Another source address and priority than in the DBC file; then a second sender of one message.
        frames.iter_mut().for_each(|(id, _)| *id = 0x0cff_0021 | *id & 0xff00);
        if index > 10 {
            frames.insert(0, (0x18ff_79e8, [50; 8]));
        }
    });
    let (recording, report) = read(&log);
    assert_state(&recording, shots);
    let told = report.problems();
    assert!(
        told.iter().any(|line| line.contains("addresses 0x21 and 0xE8") && line.contains("489 frames")),
        "{told:?}"
    );
}

#[test]
fn values_outside_the_range_of_the_frames_are_not_measured() {
    let (forms, shots) = (Forms::new(), &shots()[..200]);
    let log = forms.log(shots, |_, frames| frames[1].1[0] = 0xff);
    let (recording, report) = read(&log);
    assert!(recording.cylinder("boom").unwrap().cap_pressure.iter().all(|value| value.is_nan()));
    let told = report.problems();
    assert!(told.iter().any(|line| line.starts_with("boom.cap_pressure: 200 values outside")), "{told:?}");
}

#[test]
fn a_second_array_on_the_topic_of_the_first_is_told() {
    let (forms, shots) = (Forms::new(), &shots()[..500]);
    let (recording, report) = read(&forms.gateway(shots, true));
    assert_state(&recording, shots);
    let told = report.problems();
    assert!(
        told.iter().any(|line| line.contains("500 of 1000 messages of /main_pressure_1 have no such element")),
        "{told:?}"
    );
}

#[test]
fn of_two_machines_the_namespace_says_which() {
    let (forms, shots) = (Forms::new(), &shots()[..200]);
    let path = forms.path("both");
    let mut bag = BagWriter::create(&path, &WriteOptions::default()).unwrap();
    for (name, index) in [("/zx120/joint_states", 10), ("/zx200/joint_state", 20)] {
        let id = topic(&mut bag, name, "sensor_msgs/msg/JointState");
        for number in 0..200 {
            let at = stamp(number);
            bag.write(id, at as u64, at as u64, &cdr::encode(&joint_state(&shots[index], at)).unwrap()).unwrap();
        }
    }
    bag.finish().unwrap();
    let of = |namespace| read_recording_or_mapped(&path, Origin { map: Some(Path::new(OPERA)), namespace });
    let refused = of(None).unwrap_err().to_string();
    assert!(refused.contains("/zx120, /zx200") && refused.contains("--namespace"), "{refused}");
    let (recording, _) = of(Some("zx200")).unwrap();
    assert!((recording.cylinder("arm").unwrap().joint_angle[0] - shots[20][2].angle).abs() < 1e-9);
}

#[test]
fn data_without_the_interface_are_refused_in_one_line() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/arm-swing");
    let origin = Origin { map: Some(Path::new(OPERA)), namespace: None };
    let refused = read_recording_or_mapped(&sample, origin).unwrap_err().to_string();
    assert!(
        refused.contains("no frame of COM3") && refused.contains("/arm/state") && !refused.contains('\n'),
        "{refused}"
    );
    let forms = Forms::new();
    let log = forms.log(&shots()[..20], |_, _| {});
    let refused = read_recording_or_mapped(&log, Origin::default()).unwrap_err().to_string();
    assert!(refused.contains("--map opera"), "{refused}");
}

/// What is told of a minute that `change` makes up.
fn told(change: impl Fn(&mut Shot)) -> Vec<String> {
    let mut shots = shots().to_vec();
    shots.iter_mut().for_each(change);
    let forms = Forms::new();
    let told = read(&forms.topics(&shots, "/zx200/joint_state")).1.problems();
    // The same from frames, whose steps hide more.
    assert_eq!(read(&forms.log(&shots, |_, _| {})).1.problems(), told);
    told
}

#[test]
fn twin_pilots_are_told() {
    let told = told(|shot| shot[1].pilot[1] = shot[1].pilot[0]);
    let twins = "boom_down_pilot_pressure and boom_up_pilot_pressure are the same numbers";
    assert!(told.len() == 1 && told[0].contains(twins), "{told:?}");
}

#[test]
fn one_sided_pressures_are_told() {
    let told = told(|shot| {
        for axis in shot.iter_mut() {
            let difference = axis.main[0] - axis.main[1];
            axis.main = [difference.max(0.0), (-difference).max(0.0)];
        }
    });
    for axis in ["swing", "arm"] {
        assert!(told.iter().any(|line| line.starts_with(&format!("{axis}: only one of cap_pressure"))), "{told:?}");
    }
}

#[test]
fn pilots_in_proportion_to_the_main_pressure_are_told() {
    // The rod side of this small arm hardly moves in the steps of the frames.
    let told = told(|shot| shot[2].pilot = shot[2].main.map(|main| (0.2 * main / STEPS[2]).round() * STEPS[2]));
    let line = "arm_crowd_pilot_pressure is 0.200 of arm.cap_pressure all the time";
    assert!(told.iter().any(|told| told.starts_with(line)), "{told:?}");
}

#[test]
fn a_bucket_that_copies_the_arm_is_told() {
    let told = told(|shot| {
        shot[3].angle = shot[2].angle;
        shot[0].main[1] = shot[2].main[1];
    });
    for pair in ["arm.joint_angle and bucket.joint_angle", "swing.rod_pressure"] {
        assert!(
            told.iter().any(|line| line.contains(pair) && line.contains("a copy of the other")),
            "{pair}: {told:?}"
        );
    }
}

#[test]
fn placeholders_are_told() {
    let told = told(|shot| shot[3].main = [0.0, 0.0]);
    for side in ["cap", "rod"] {
        let line = format!("bucket.{side}_pressure is 0 all the time");
        assert!(told.iter().any(|told| told.starts_with(&line)), "{told:?}");
    }
}
