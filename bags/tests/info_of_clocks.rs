//! What `info` says of clocks and signals.

#![allow(clippy::unwrap_used)]

mod support;

use excavator_bags::{BagWriter, Qos, SignalsInfo, TopicInfo, TopicToWrite, WriteOptions, cdr, info};
use excavator_model::recording::Recording;
use excavator_msgs::ArmState;
use support::state;

const MS: i64 = 1_000_000;

/// A bag with a state message per pair of stamp and log time, ns.
fn topic(times: &[(i64, i64)]) -> TopicInfo {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag");
    let mut bag = BagWriter::create(&path, &WriteOptions::default()).unwrap();
    let id = bag.add_topic(&TopicToWrite::of::<ArmState>("/arm/state", Qos::reliable(10))).unwrap();
    for &(stamp, log) in times {
        bag.write(id, log as u64, log as u64, &cdr::encode(&state(stamp, &["arm"])).unwrap()).unwrap();
    }
    bag.finish().unwrap();
    info(&path).unwrap().topics.remove(0)
}

#[test]
fn gaps_jitter_and_delay_are_measured() {
    // 2 ms apart, every other 0.1 ms late, one missing; logged 5 ms later.
    let stamps = (1..=200).filter(|i| *i != 100).map(|i| 2 * i * MS + (i % 2) * MS / 10);
    let timing = topic(&stamps.map(|stamp| (stamp, stamp + 5 * MS)).collect::<Vec<_>>()).timing.unwrap();
    assert!(timing.from_stamps);
    assert!((timing.median_interval - 2e-3).abs() < 0.11e-3, "{}", timing.median_interval);
    assert!((timing.jitter - 0.2e-3).abs() < 0.11e-3, "{}", timing.jitter);
    assert_eq!((timing.gaps, timing.log_times_backwards), (1, 0));
    assert!((timing.longest_interval - 4e-3).abs() < 1e-9);
    assert!((timing.longest_interval_at - 0.196).abs() < 1e-9, "{}", timing.longest_interval_at);
    let stamps = timing.stamps.unwrap();
    assert_eq!((stamps.zero, stamps.backwards, stamps.repeated), (0, 0, 0));
    assert!((stamps.median_delay - 5e-3).abs() < 1e-12);
}

#[test]
fn clocks_that_step_or_were_never_set_are_found() {
    let backwards = topic(&[(1, 10), (3, 30), (2, 20), (3, 40), (5, 50)].map(|(a, b)| (a * MS, b * MS)));
    let timing = backwards.timing.unwrap();
    let stamps = timing.stamps.unwrap();
    assert_eq!((timing.log_times_backwards, stamps.backwards, stamps.repeated), (1, 1, 1));
    assert_eq!(stamps.delay_range, (0.009, 0.045));
    let unset = topic(&[(0, 10 * MS), (0, 20 * MS), (0, 30 * MS)]).timing.unwrap();
    assert!(!unset.from_stamps);
    assert_eq!((unset.stamps.unwrap().zero, unset.median_interval), (3, 0.01));
    assert_eq!(topic(&[(MS, MS)]).timing, None);
}

#[test]
fn what_is_missing_for_each_equation_is_named() {
    let mut recording = Recording::unmeasured("made up", vec![0.0, 1.0, 2.0, 3.0], &["arm"]);
    let equations = |recording: &Recording| -> Vec<(String, Vec<String>)> {
        SignalsInfo::of(recording).equations.into_iter().map(|e| (e.equation, e.missing)).collect()
    };
    let nothing = equations(&recording);
    assert_eq!(nothing.len(), 1);
    assert_eq!((nothing[0].0.as_str(), nothing[0].1.len()), ("arm motion", 2));
    let arm = &mut recording.cylinders[0];
    arm.displacement = vec![0.1, f64::NAN, 0.2, -0.3];
    arm.rod_force.fill(5.0);
    assert_eq!(equations(&recording), [("arm motion".to_string(), vec![])]);
    let arm = &mut recording.cylinders[0];
    arm.cap_pressure.fill(1e6);
    let missing = |names: &[&str]| names.iter().map(ToString::to_string).collect::<Vec<_>>();
    let opening = "arm.orifice_area or arm.orifice_command";
    let expected = [
        ("arm motion".to_string(), missing(&[])),
        ("arm chambers".to_string(), missing(&["arm.rod_pressure", opening])),
        ("pump line".to_string(), missing(&["pump_pressure", opening])),
    ];
    assert_eq!(equations(&recording), expected);
    // A supply or a tank that nobody measures may be a constant of the machine.
    let constant: Vec<_> = SignalsInfo::of(&recording).equations.into_iter().map(|e| e.constant).collect();
    assert_eq!(constant[1], missing(&["pump_pressure", "tank_pressure"]));
    assert_eq!(constant[2], missing(&["tank_pressure", "pump_flow"]));
    let signals = SignalsInfo::of(&recording);
    let displacement = &signals.measured[0];
    assert_eq!((displacement.missing, displacement.least, displacement.most), (0.25, -0.3, 0.2));
}
