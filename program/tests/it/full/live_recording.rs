//! Recorder and player between processes: nothing lost, nothing changed, and a killed recorder loses a second at most.

use crate::live::{Network, custom_number, folder, messages, recorded, records};
use std::path::Path;

use excavator_msgs::common::DiagnosticArray;
use excavator_msgs::{ArmState, EnergyState};

#[test]
fn everything_at_1_khz_is_recorded_and_balanced() {
    let Some(network) = Network::new("record") else { return };
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let up = network.start(&["up", "-o", bag.to_str().unwrap(), "-d", "8"]);
    let (status, log) = up.wait();
    assert_eq!(status, 0, "{log}");
    let logged: Vec<(f64, ArmState)> = messages(&bag, "/arm/state");
    let states: Vec<&ArmState> = logged.iter().map(|(_, state)| state).collect();
    let energies: Vec<EnergyState> = messages(&bag, "/arm/energy").into_iter().map(|(_, energy)| energy).collect();
    assert!(states.len() > 1000, "{}: {log}", states.len());
    assert_eq!(custom_number(&bag, "lost_messages:/arm/state"), 0);
    assert_eq!(custom_number(&bag, "lost_messages:/arm/energy"), 0);
    assert_eq!(custom_number(&bag, "dropped_by_recorder"), 0);
    // Samples are a period apart, however late they were sent, except where the simulator has counted a restart of its schedule.
    let (told_at, restarts) = restarts(&bag);
    let is_uneven = |pair: &&[(f64, ArmState)]| {
        let step = pair[1].1.header.stamp.nanoseconds() - pair[0].1.header.stamp.nanoseconds();
        (step - 1_000_000).abs() > 10_000
    };
    // What was logged shortly before may have been published after it.
    let before = logged.windows(2).filter(|pair| pair[1].0 < told_at - 0.5);
    let uneven = before.filter(is_uneven).count();
    assert!(uneven <= restarts, "{uneven} uneven steps, {restarts} restarts of the schedule");
    // One balance per state, with its stamp: compare where both were recorded.
    let (first, last) = (energies[0].header.stamp, energies[energies.len() - 1].header.stamp);
    let inside: Vec<_> =
        states.iter().map(|state| state.header.stamp).filter(|stamp| (first..=last).contains(stamp)).collect();
    let stamps: Vec<_> =
        energies.iter().map(|energy| energy.header.stamp).filter(|stamp| *stamp >= states[0].header.stamp).collect();
    let missing = inside.iter().filter(|stamp| !stamps.contains(stamp)).count();
    assert_eq!(missing, 0, "of {} states", inside.len());
    // The valve is closed when the simulator has gone.
    assert_eq!(states[states.len() - 1].cylinders[0].orifice_area, 0.0);
}

/// When the simulator told of its schedule for the last time, log time in s, and how often it had restarted it.
fn restarts(bag: &Path) -> (f64, usize) {
    let told = messages::<DiagnosticArray>(bag, "/diagnostics").into_iter().flat_map(|(time, array)| {
        let values = array.status.into_iter().flat_map(|status| status.values);
        values.filter(|value| value.key == "schedule restarts").map(move |value| (time, value.value.parse().unwrap()))
    });
    told.last().expect("diagnostics of the simulator")
}

#[test]
fn a_demo_moves_by_itself_and_shows_itself() {
    let Some(network) = Network::new("demo") else { return };
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let up = network.start(&["up", "--demo", "-o", bag.to_str().unwrap(), "-d", "12"]);
    let (status, log) = up.wait();
    assert_eq!(status, 0, "{log}");
    assert!(log.contains("[dashboard]"), "{log}");
    let states: Vec<ArmState> = messages(&bag, "/arm/state").into_iter().map(|(_, state)| state).collect();
    let positions = states.iter().map(|state| state.cylinders[0].displacement);
    let (least, most) = positions.fold((f64::MAX, f64::MIN), |(low, high), at| (low.min(at), high.max(at)));
    assert!(most - least > 0.02, "{} m in {} states: {log}", most - least, states.len());
    let model = excavator_model::document::built_in("zx30u-arm").unwrap();
    let arm = &model.machine.cylinders[0];
    assert!(!arm.is_near_an_end(least, 0.1) && !arm.is_near_an_end(most, 0.1), "{least} m to {most} m: {log}");
}

#[test]
fn what_is_played_is_what_was_recorded() {
    let Some(network) = Network::new("play") else { return };
    let (_keep, folder) = folder();
    let (first, second) = (folder.join("first"), folder.join("second"));
    let simulator = network.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"]);
    let recorder = network.start(&["record", "/arm/state", "/arm/model", "-o", first.to_str().unwrap()]);
    records(&first, "/arm/state", 800);
    assert_eq!(recorder.interrupt().0, 0);
    assert_eq!(simulator.interrupt().0, 0);
    let again = network.start(&["record", "/left/state", "/arm/model", "/diagnostics", "-o", second.to_str().unwrap()]);
    let player = network.start(&[
        "play",
        first.to_str().unwrap(),
        "--rate",
        "2",
        "--remap",
        "/arm/state:=/left/state",
        "--start-paused",
    ]);
    again.says("recording /left/state (");
    again.says("recording /arm/model (");
    // The player hears of the recorder's readers on the way that brings its diagnostics to the recorder.
    records(&second, "/diagnostics", 2);
    player.signal("-USR1");
    assert_eq!(player.wait().0, 0);
    let (status, log) = again.interrupt();
    assert_eq!(status, 0, "{log}");
    let before: Vec<(f64, ArmState)> = messages(&first, "/arm/state");
    let after: Vec<(f64, ArmState)> = messages(&second, "/left/state");
    assert!(before.len() > 500, "{}", before.len());
    assert_eq!(before.len(), after.len(), "{log}");
    // NaN is not equal to itself: compare what is printed.
    assert!(before.iter().zip(&after).all(|(old, new)| format!("{:?}", old.1) == format!("{:?}", new.1)));
    let length = |messages: &[(f64, ArmState)]| messages[messages.len() - 1].0 - messages[0].0;
    let ratio = length(&before) / length(&after);
    assert!((1.5..2.5).contains(&ratio), "{ratio}");
    // A latched topic is played latched.
    assert_eq!(messages::<excavator_msgs::common::Text>(&second, "/arm/model").len(), 1);
}

#[test]
fn a_killed_recorder_loses_the_last_second_and_nothing_before() {
    let Some(network) = Network::new("kill") else { return };
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let _simulator = network.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=500"]);
    let recorder = network.start(&["record", "--all", "-o", bag.to_str().unwrap()]);
    // Every second reaches the disk by itself: what is recorded grows while the recorder still runs.
    for _ in 0..5 {
        records(&bag, "/arm/state", 150);
    }
    let on_disk = recorded(&bag, "/arm/state");
    recorder.kill();
    assert!(!bag.join("metadata.yaml").exists());
    let states: Vec<(f64, ArmState)> = messages(&bag, "/arm/state");
    assert!(on_disk > 500 && states.len() >= on_disk, "{on_disk} before, {} after", states.len());
    assert_eq!(rosbag2::info(&bag).unwrap().topics.iter().filter(|topic| topic.name == "/arm/state").count(), 1);
}
