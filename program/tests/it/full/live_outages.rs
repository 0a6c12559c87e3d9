//! Two machines joined by a cable, and what can happen to cable and programs.

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use crate::live::{
    Network, Program, custom_number, folder, messages, openings, python_with_cyclone, records, sleep, until,
};
use excavator_msgs::ArmState;
use excavator_msgs::common::DiagnosticArray;

struct Line {
    left: Network,
    _right: Network,
    simulator: Program,
    recorder: Program,
}

/// Simulator left, recorder right, and some states that have come through.
fn line(name: &str, bag: &Path) -> Option<Line> {
    let (left, right) = Network::pair(name)?;
    let simulator = left.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"]);
    let recorder = right.start(&["record", "/arm/state", "-o", bag.to_str().unwrap()]);
    records(bag, "/arm/state", 400);
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

/// What a recorder has of an outage of so many seconds, and of some more after it.
struct Outage {
    stamps: Vec<f64>,
    lost: u64,
    log: String,
}

/// `afterwards`: so many seconds of states behind the outage, s.
fn outage(name: &str, duration: f64, afterwards: f64) -> Option<Outage> {
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let line = line(name, &bag)?;
    line.left.unplug();
    sleep(duration);
    line.left.plug();
    let plugged = now();
    until("states from after the outage", || {
        openings(&bag).last().is_some_and(|(stamp, _)| *stamp > plugged + afterwards)
    });
    let (stamps, log) = end(line, &bag);
    println!("silent for {:.1} s\n{log}", longest_gap(&stamps));
    Some(Outage { stamps, lost: custom_number(&bag, "lost_messages:/arm/state"), log })
}

#[test]
fn an_unplugged_cable_of_five_seconds_costs_nothing() {
    let Some(Outage { stamps, lost, log }) = outage("five", 5.0, 2.0) else { return };
    assert_eq!(lost, 0);
    // The states of the outage were kept and sent after it; a busy machine may be late by less than half of it.
    assert!(longest_gap(&stamps) < 2.5, "{}: {log}", longest_gap(&stamps));
}

#[test]
#[ignore = "takes a minute"]
fn an_unplugged_cable_of_thirty_seconds_loses_nothing_that_is_not_counted() {
    let Some(Outage { stamps, lost, log }) = outage("thirty", 30.0, 5.0) else { return };
    let missing: f64 = stamps.windows(2).map(|pair| pair[1] - pair[0] - 0.005).filter(|gap| *gap > 0.002).sum();
    assert!((lost as f64 - 200.0 * missing).abs() <= 2.0, "{lost} counted, {} missing: {log}", 200.0 * missing);
}

#[test]
#[ignore = "takes two minutes"]
fn an_outage_longer_than_every_lease_ends_within_seconds_of_the_cable() {
    // Waiting for states from after the outage is the test.
    let Some(Outage { stamps, log, .. }) = outage("long", 70.0, 5.0) else { return };
    assert!(longest_gap(&stamps) > 60.0, "{}: {log}", longest_gap(&stamps));
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
    // In quick succession, so that the link freezes while it is being built anew: the middleware hangs for good then.
    for _ in 0..3 {
        for _ in 0..12 {
            line.simulator.signal("-STOP");
            sleep(0.03);
            line.simulator.signal("-CONT");
            sleep(0.015);
        }
        sleep(1.0);
    }
    let thawed = now();
    until("ten seconds of states", || openings(&bag).last().is_some_and(|(stamp, _)| *stamp > thawed + 10.0));
    let (stamps, log) = end(line, &bag);
    let tail = stamps.iter().filter(|stamp| **stamp > stamps[stamps.len() - 1] - 2.0).count();
    assert!(tail > 100, "{tail} states in the last two seconds of 200 Hz: {log}");
}

fn now() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs_f64()
}

/// When the operator heard states, s since the epoch.
fn arrivals(log: &Path) -> Vec<f64> {
    std::fs::read_to_string(log).unwrap_or_default().lines().filter_map(|line| line.parse().ok()).collect()
}

/// Operator (Cyclone), recorder and energy monitor (Rust) on one side, the arm on the other, and two minutes without a
/// cable between them: longer than the lease of any participant.
#[test]
#[ignore = "takes three minutes"]
fn after_two_minutes_without_a_cable_all_peers_find_each_other_again() {
    const OUTAGE: f64 = 120.0;
    const OPEN: f64 = 2e-5;
    let Some(python) = python_with_cyclone() else { return };
    let Some((left, right)) = Network::pair("two") else { return };
    let (_keep, folder) = folder();
    let (near, far) = (folder.join("near"), folder.join("far"));
    let simulator = left.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"]);
    let near_recorder = left.start(&["record", "/arm/state", "-o", near.to_str().unwrap()]);
    let far_recorder = right.start(&["record", "/arm/state", "/diagnostics", "-o", far.to_str().unwrap()]);
    let monitor = right.start(&["node", "energy-monitor", "--ros-args", "-p", "model:=zx30u-arm"]);
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/rclpy");
    let log = folder.join("arrivals");
    let words = [tests.join("support/operator_peer.py"), log.clone()];
    let network = "<General><Interfaces><NetworkInterface name='cable'/></Interfaces></General>";
    let standin = tests.join("standin");
    let environment = [("PYTHONPATH", standin.to_str().unwrap()), ("CYCLONEDDS_URI", network)];
    let words: Vec<&str> = words.iter().map(|word| word.to_str().unwrap()).collect();
    let operator = right.start_other(&python, &words, &environment);
    records(&far, "/arm/state", 200);
    until("the operator to be heard", || openings(&near).iter().any(|(_, area)| (area - OPEN).abs() < 1e-9));
    // Nothing comes through from here on: pulling the cable takes a few tenths of a second itself.
    left.unplug();
    let unplugged = now();
    sleep(OUTAGE);
    left.plug();
    let plugged = now();
    until("the operator to be heard again", || {
        openings(&near).iter().any(|(stamp, area)| *stamp > plugged && (area - OPEN).abs() < 1e-9)
    });
    until("states at the recorder again", || openings(&far).last().is_some_and(|(stamp, _)| *stamp > plugged + 1.0));
    until("states at the operator again", || arrivals(&log).last().is_some_and(|time| *time > plugged));
    let far_log = far_recorder.interrupt();
    let operator_log = operator.interrupt();
    assert_eq!((far_log.0, operator_log.0), (0, 0), "{} {}", far_log.1, operator_log.1);
    for program in [monitor, near_recorder, simulator] {
        let (status, log) = program.interrupt();
        assert_eq!(status, 0, "{log}");
    }

    let near = openings(&near);
    let before: Vec<_> = near.iter().filter(|(stamp, _)| *stamp < unplugged).collect();
    assert!(before.iter().any(|(_, area)| (area - OPEN).abs() < 1e-9), "the operator was not heard before");
    // 0.1 s for the lease, 0.2 s for the ramp, and what was on its way.
    let during: Vec<_> = near.iter().filter(|(stamp, _)| (unplugged + 1.0..plugged).contains(stamp)).collect();
    assert!(during.len() > 10_000, "{} states while the cable was out", during.len());
    assert!(during.iter().all(|(_, area)| *area == 0.0), "the valve was open while nobody could close it");
    let closed = near.iter().find(|(stamp, area)| *stamp > unplugged && *area == 0.0).unwrap().0 - unplugged;
    let heard = near.iter().find(|(stamp, area)| *stamp > plugged && (*area - OPEN).abs() < 1e-9);
    let arrivals = arrivals(&log);
    let at_operator = arrivals.iter().find(|time| **time > plugged);
    // What was sent before and came late does not show that the connection is there again.
    let at_recorder = openings(&far).into_iter().find(|(stamp, _)| *stamp > plugged);
    let gaps = messages::<DiagnosticArray>(&far, "/diagnostics")
        .into_iter()
        .flat_map(|(_, array)| array.status)
        .filter(|status| status.name.starts_with("energy_monitor"))
        .flat_map(|status| status.values)
        .filter(|value| value.key == "gaps")
        .filter_map(|value| value.value.parse::<u32>().ok())
        .max();
    println!("valve closed after {closed:.2} s; gaps counted by the monitor: {gaps:?}");
    let metadata = std::fs::read_to_string(far.join("metadata.yaml")).unwrap();
    let silence = metadata.lines().find(|line| line.contains("longest_silence_seconds:/arm/state")).unwrap();
    let silence: f64 = silence.rsplit('\'').nth(1).unwrap().parse().unwrap();
    println!("silence in the bag's metadata: {silence:.1} s");
    for (who, time) in [
        ("simulator follows the Cyclone operator", heard.map(|found| found.0)),
        ("Cyclone operator hears the state", at_operator.copied()),
        ("Rust recorder hears the state", at_recorder.map(|found| found.0)),
    ] {
        let after = time.unwrap_or_else(|| panic!("{who}: never again\n{}{}", far_log.1, operator_log.1)) - plugged;
        println!("{who} {after:.1} s after the cable");
    }
    assert!(closed < 2.0, "{closed}");
    assert!(gaps.is_some_and(|gaps| gaps >= 1), "{gaps:?}");
    assert!(silence > 0.9 * OUTAGE, "{silence}");
}
