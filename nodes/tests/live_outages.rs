//! Two machines joined by a cable, and what can happen to cable and programs.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod live;

use std::path::Path;

use excavator_msgs::ArmState;
use live::{Network, Program, custom_number, folder, messages, sleep};

struct Line {
    left: Network,
    _right: Network,
    simulator: Program,
    recorder: Program,
}

/// Simulator left, recorder right, and three seconds of peace.
fn line(name: &str, bag: &Path) -> Option<Line> {
    let (left, right) = Network::pair(name)?;
    let simulator = left.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"]);
    let recorder = right.start(&["record", "/arm/state", "-o", bag.to_str().unwrap()]);
    sleep(4.0);
    Some(Line { left, _right: right, simulator, recorder })
}

/// Ends both; returns stamps (s, after the first) and logs.
fn end(line: Line, bag: &Path) -> (Vec<f64>, String) {
    let (status, recorder) = line.recorder.interrupt();
    assert_eq!(status, 0, "{recorder}");
    let (status, simulator) = line.simulator.interrupt();
    assert_eq!(status, 0, "{simulator}");
    let states: Vec<(f64, ArmState)> = messages(bag, "/arm/state");
    let stamp = |state: &ArmState| state.header.stamp.nanoseconds() as f64 * 1e-9;
    let first = stamp(&states[0].1);
    (states.iter().map(|(_, state)| stamp(state) - first).collect(), recorder + &simulator)
}

/// The longest time between two stamps.
fn longest_gap(stamps: &[f64]) -> f64 {
    stamps.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
}

#[test]
fn an_unplugged_cable_of_five_seconds_costs_nothing() {
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let Some(line) = line("five", &bag) else { return };
    line.left.unplug();
    sleep(5.0);
    line.left.plug();
    sleep(8.0);
    let (stamps, log) = end(line, &bag);
    assert_eq!(custom_number(&bag, "lost_messages:/arm/state"), 0);
    assert!(stamps[stamps.len() - 1] > 14.0, "{}: {log}", stamps[stamps.len() - 1]);
    assert!(longest_gap(&stamps) < 0.5, "{}: {log}", longest_gap(&stamps));
}

#[test]
#[ignore = "takes two minutes"]
fn an_outage_longer_than_every_lease_ends_within_seconds_of_the_cable() {
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let Some(line) = line("long", &bag) else { return };
    line.left.unplug();
    sleep(70.0);
    line.left.plug();
    sleep(25.0);
    let (stamps, log) = end(line, &bag);
    let gap = longest_gap(&stamps);
    println!("silent for {gap:.1} s\n{log}");
    assert!(gap < 85.0, "{gap}: {log}");
    assert!(stamps[stamps.len() - 1] > 90.0, "{log}");
}

#[test]
fn a_program_that_was_frozen_speaks_again() {
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let Some(line) = line("frozen", &bag) else { return };
    for _ in 0..5 {
        line.simulator.signal("-STOP");
        sleep(0.3);
        line.simulator.signal("-CONT");
        sleep(0.3);
    }
    sleep(8.0);
    let (stamps, log) = end(line, &bag);
    assert!(stamps[stamps.len() - 1] > 12.0, "{}: {log}", stamps[stamps.len() - 1]);
    let tail = stamps.iter().filter(|stamp| **stamp > stamps[stamps.len() - 1] - 2.0).count();
    assert!(tail > 300, "{tail} states in the last two seconds: {log}");
}
