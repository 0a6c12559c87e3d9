//! A stranger on a network that is secured with DDS Security.

use std::path::Path;

use excavator_msgs::ArmState;

use crate::hostile::fault::Fault;
use crate::hostile::full::keystore::{Enclave, Keystore};
use crate::hostile::full::network::{COMMANDS, MOST_MEMORY, Operator, heartbeat, look, pairs, peak};
use crate::hostile::inside::start_inside;
use crate::live::{Network, Program, folder, messages, messages_so_far, records, sleep, until};

/// Time for peers to authenticate each other, s.
const MEETING: f64 = 16.0;

const ENCLAVES: [Enclave; 4] = [
    Enclave { name: "/arm/simulator", publishes: &["rt/arm/state", "rt/arm/model", "rt/joint_states"] },
    Enclave { name: "/arm/monitor", publishes: &["rt/arm/energy"] },
    Enclave { name: "/recorder", publishes: &[] },
    Enclave { name: "/operator", publishes: &["rt/arm/orifice_command"] },
];

fn start(network: &Network, words: &[&str], environment: &[(&str, &str)]) -> Program {
    network.start_other(Path::new(env!("CARGO_BIN_EXE_excavator")), words, environment)
}

/// States in a bag, and those with an open valve of the arm.
fn states(bag: &Path) -> (usize, usize) {
    let states: Vec<(f64, ArmState)> = messages(bag, "/arm/state");
    (states.len(), states.iter().filter(|(_, state)| state.cylinders[0].orifice_area > 0.0).count())
}

/// Simulator with keys; `permitted`: whether its valve is to open before all ends. Whether it hears the operator, who may have keys, is in what a recorder with keys has of it.
fn commanded(
    name: &str,
    keystore: &Keystore,
    options: ros2_client::ContextOptions,
    permitted: bool,
) -> Option<(usize, usize, String)> {
    let network = Network::new(name)?;
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let words = ["record", "/arm/state", "-o", bag.to_str().unwrap()];
    let recorder = start(&network, &words, &keystore.environment("/recorder"));
    let words = ["node", "arm-simulator", "--ros-args", "-p", "rate:=200"];
    let simulator = start(&network, &words, &keystore.environment("/arm/simulator"));
    let operator = Operator::new(&network, options);
    records(&bag, "/arm/state", 200);
    operator.opens();
    if permitted {
        let open = |(_, state): &(f64, ArmState)| state.cylinders[0].orifice_area > 0.0;
        until("100 states with an open valve", || {
            messages_so_far::<ArmState>(&bag, "/arm/state").iter().filter(|state| open(state)).count() > 100
        });
    } else {
        sleep(MEETING);
        records(&bag, "/arm/state", 200);
    }
    operator.falls_silent().unwrap();
    let (recorded, log) = recorder.interrupt();
    let (simulated, other) = simulator.interrupt();
    assert_eq!((recorded, simulated), (0, 0), "{log}{other}");
    let (all, open) = states(&bag);
    println!("{name}: {all} states, {open} with an open valve");
    Some((all, open, log + &other))
}

fn keys(keystore: &Keystore, enclave: &str) -> ros2_client::ContextOptions {
    ros2_client::ContextOptions::new().enable_security(keystore.folder(enclave), String::new())
}

#[test]
fn peers_with_keys_talk_and_others_neither_command_nor_read() {
    let keystore = Keystore::new(&ENCLAVES, "ENCRYPT");
    let Some((all, open, log)) = commanded("keys", &keystore, keys(&keystore, "/operator"), true) else { return };
    assert!(all > 400 && open > 100, "{all} states, {open} with an open valve: {log}");
    let (all, without_keys, log) = commanded("nokeys", &keystore, ros2_client::ContextOptions::new(), false).unwrap();
    assert!(all > 400 && without_keys == 0, "{all} states, {without_keys} with an open valve: {log}");
    let network = Network::new("reader").unwrap();
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let recorder = start(&network, &["record", "--all", "-o", bag.to_str().unwrap()], &[]);
    let simulator = start(&network, &["node", "arm-simulator"], &keystore.environment("/arm/simulator"));
    sleep(MEETING);
    let (_, log) = recorder.interrupt();
    simulator.interrupt();
    assert!(!log.contains("/arm/state"), "{log}");
    let options = keys(&keystore, "/arm/monitor");
    let refused = Operator::new(&network, options).falls_silent();
    assert!(refused.is_err(), "keys without permission make a writer of commands");
    Fault {
        group: "Network",
        tried: "a participant without keys, and one whose permissions do not name the command topic, on a network with DDS Security",
        outcome: "the one without keys moves no valve and sees no topic, the other cannot make a writer; those with keys and permission do both",
    }
    .survived(&[("states with an open valve, by a permitted operator", open.to_string())]);
}

#[test]
fn a_heartbeat_without_keys_does_nothing_even_without_the_guard() {
    let keystore = Keystore::new(&ENCLAVES, "ENCRYPT");
    let Some((left, right)) = Network::pair("signed") else { return };
    let mut environment = keystore.environment("/arm/simulator").to_vec();
    environment.push(("EXCAVATOR_PACKET_GUARD", "off"));
    let simulator = start(&left, &["node", "arm-simulator", "--ros-args", "-p", "rate:=200"], &environment);
    let operator = Operator::new(&left, keys(&keystore, "/operator"));
    // Somebody who once had keys knows the identities; the packets are not protected.
    let options = keystore.folder("/recorder");
    let sent = start_inside(&right, move || {
        let files = rustdds::DomainParticipantSecurityConfigFiles::with_ros_default_names(options, String::new());
        let participant = rustdds::DomainParticipantBuilder::new(0).builtin_security(files).build().unwrap();
        std::thread::sleep(std::time::Duration::from_secs_f64(MEETING));
        let seen = look(&participant);
        let socket = std::net::UdpSocket::bind("0.0.0.0:0").unwrap();
        let mut sent = 0;
        for (reader, writer) in pairs(&seen).into_iter().filter(|(reader, _)| reader.topic == COMMANDS) {
            for count in 0..15 {
                for address in &reader.addresses {
                    socket.send_to(&heartbeat(reader, writer, 1 << 26, 1_000_000 + count), address).unwrap();
                    sent += 1;
                }
            }
        }
        sent
    })
    .join()
    .unwrap();
    assert!(sent >= 15, "{sent} packets sent");
    sleep(3.0);
    operator.falls_silent().unwrap();
    let megabytes = peak(&simulator);
    simulator.interrupt();
    assert!(megabytes < MOST_MEMORY, "{megabytes} MB");
    Fault {
        group: "Network",
        tried: "the same HEARTBEATs on a network with DDS Security, packet guard off",
        outcome: "refused by the middleware, since they are not protected",
    }
    .survived(&[("packets sent", sent.to_string()), ("memory of the simulator [MB]", format!("{megabytes:.0}"))]);
}
