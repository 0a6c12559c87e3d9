//! Packets that the guard must let through, forged: a late joiner is told the same of a writer that has run for days.
//!
//! What is asserted is that states and commands that are published afterwards still arrive.

use std::net::SocketAddr;
use std::path::Path;

use excavator_msgs::EnergyState;

use crate::hostile::fault::Fault;
use crate::live::{Network, Program, folder, found, messages_so_far, openings, records, until};

use super::network::{
    COMMANDS, Operator, Seen, acknowledged, count, fragment, gap, heartbeat_from, now, operator_of, pairs, stranger,
};

/// Number of a sample that no writer reaches.
const FAR: i64 = 1 << 31;
const STATES: &str = "rt/arm/state";

/// Time of the processor that a program has used, s.
fn processor_time(program: &Program) -> f64 {
    let text = std::fs::read_to_string(format!("/proc/{}/stat", program.id())).unwrap();
    let fields: Vec<&str> = text.rsplit(')').next().unwrap().split_whitespace().collect();
    // The fields after the name begin with the third: utime and stime are the 14th and 15th, in hundredths of a second.
    (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
}

/// Stamps of the energy balances in a bag so far, s since the epoch.
fn balances(bag: &Path) -> Vec<f64> {
    let found: Vec<(f64, EnergyState)> = messages_so_far(bag, "/arm/energy");
    found.iter().map(|(_, energy)| energy.header.stamp.nanoseconds() as f64 * 1e-9).collect()
}

fn longest_gap(stamps: impl Iterator<Item = f64>) -> f64 {
    let stamps: Vec<f64> = stamps.collect();
    stamps.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
}

/// Simulator, monitor, recorder and dashboard hear each other and an operator; then a stranger sends its packets to every
/// reader or writer. States, balances and commands go on.
fn goes_on(
    name: &str,
    tried: &'static str,
    packets: impl Fn(&Seen) -> Vec<(Vec<u8>, Vec<SocketAddr>)> + Send + 'static,
) {
    let Some((left, right)) = Network::pair(name) else { return };
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let programs = [
        ("simulator", left.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"])),
        ("monitor", left.start(&["node", "energy-monitor", "--ros-args", "-p", "model:=zx30u-arm"])),
        ("dashboard", left.start(&["dashboard", "--port", "0"])),
        ("recorder", left.start(&["record", "/arm/state", "/arm/energy", "-o", bag.to_str().unwrap()])),
    ];
    let operator = Operator::new(&left, ros2_client::ContextOptions::new());
    records(&bag, "/arm/energy", 100);
    operator.opens();
    until("an open valve", || openings(&bag).iter().any(|(_, area)| *area > 0.0));
    let all = |seen: &Seen| {
        count(&seen.readers, STATES) >= 3
            && count(&seen.readers, COMMANDS) >= 1
            && [COMMANDS, STATES, "rt/arm/energy"].into_iter().all(|topic| count(&seen.writers, topic) >= 1)
    };
    let sent = stranger(&right, all, packets).join().unwrap();
    let attacked = now();
    until("states of three seconds after the attack", || {
        openings(&bag).last().is_some_and(|(stamp, _)| *stamp > attacked + 3.0)
    });
    // A valve that closed for want of commands wants a closed one first.
    operator.closes();
    let closed = now();
    until("a valve that is closed for a second", || {
        openings(&bag).last().is_some_and(|(stamp, area)| *stamp > closed + 1.0 && *area == 0.0)
    });
    let before: Vec<f64> = programs.iter().map(|(_, program)| processor_time(program)).collect();
    let reopened = now();
    operator.opens();
    let opened = found("a valve that opens again", || {
        openings(&bag).into_iter().find(|(stamp, area)| *stamp > reopened && *area > 0.0)
    });
    until("energy of three seconds afterwards", || balances(&bag).last().is_some_and(|stamp| *stamp > opened.0 + 3.0));
    let passed = now() - reopened;
    let used = programs.iter().zip(before).map(|((_, program), before)| (processor_time(program) - before) / passed);
    let busiest = used.fold(0.0, f64::max);
    operator.falls_silent().unwrap();
    for (name, program) in programs.into_iter().rev() {
        let (status, log) = program.interrupt();
        assert_eq!(status, 0, "{name}: {log}");
    }
    let states = longest_gap(openings(&bag).into_iter().map(|(stamp, _)| stamp));
    let energy = longest_gap(balances(&bag).into_iter());
    // A second of silence, and ten times what opening a reader takes on a busy machine.
    assert!(states < 10.0, "no state for {states} s");
    assert!(energy < 10.0, "no balance for {energy} s");
    // At 200 Hz each needs a tenth of a core, on a busy machine half of one; a program that spins has a whole one.
    assert!(busiest < 0.9, "{busiest:.2} cores in use");
    Fault {
        group: "Network",
        tried,
        outcome: "a second reader proves that the first one is deaf and takes its place; states, balances and commands go on",
    }
    .survived(&[
        ("packets sent", sent.to_string()),
        ("longest time without a state [s]", format!("{states:.2}")),
        ("longest time without a balance [s]", format!("{energy:.2}")),
        ("busiest program afterwards [cores]", format!("{busiest:.2}")),
    ]);
}

#[test]
fn gaps_from_the_first_sample_to_a_far_one() {
    goes_on("gap", "GAPs from number 1 to 2^31, in the name of every matched writer", |seen| {
        let each = pairs(seen).into_iter();
        each.map(|(reader, writer)| (gap(reader, writer, 1, FAR), reader.addresses.clone())).collect()
    });
}

#[test]
fn heartbeats_whose_first_sample_is_far() {
    goes_on("far", "HEARTBEATs with 2^31 as first number, in the name of every matched writer", |seen| {
        let each = pairs(seen).into_iter();
        each.map(|(reader, writer)| (heartbeat_from(reader, writer, [FAR, FAR], 1_000_000), reader.addresses.clone()))
            .collect()
    });
}

#[test]
fn acknowledgements_and_fragments_of_far_samples() {
    goes_on(
        "ack",
        "ACKNACKs and fragments of samples with number 2^31, from every matched reader and writer",
        |seen| {
            let operator = operator_of(seen);
            let each = pairs(seen).into_iter();
            each.flat_map(|(reader, writer)| {
                let to_writer =
                    if Some(writer.participant()) == operator { Vec::new() } else { writer.addresses.clone() };
                [
                    (acknowledged(reader, writer, FAR, 1_000_000), to_writer),
                    (fragment(reader, writer, FAR, 1 << 12), reader.addresses.clone()),
                ]
            })
            .collect()
        },
    );
}
