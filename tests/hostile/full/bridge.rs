//! Datagrams to the bridge.

use std::net::UdpSocket;
use std::path::Path;

use excavator_msgs::ArmState;
use excavator_msgs::common::DiagnosticArray;

use crate::hostile::fault::Fault;
use crate::hostile::inside::inside;
use crate::live::{Network, folder, messages, messages_so_far, records, sleep, until};

/// The last value that the bridge told of its signals under a key; empty where it told none yet.
fn value(bag: &Path, key: &str) -> String {
    let statuses =
        messages_so_far::<DiagnosticArray>(bag, "/diagnostics").into_iter().flat_map(|(_, array)| array.status);
    let mut entries = statuses.filter(|status| status.name.ends_with("signals")).flat_map(|status| status.values);
    entries.rfind(|entry| entry.key == key).map(|entry| entry.value).unwrap_or_default()
}

/// Waits until the bridge tells this value.
fn tells(bag: &Path, key: &str, wanted: &str) {
    until(&format!("{key} = {wanted}"), || value(bag, key) == wanted);
}

/// Waits until states and diagnostics of the bridge reach the recorder.
fn is_heard(bag: &Path) {
    records(bag, "/arm/state", 1);
    records(bag, "/diagnostics", 2);
}

const DESCRIPTION: &str = r#"
rate = 100.0
[[udp]]
port = 5600
ADDRESS
length = 6
sequence = { at = 4, kind = "u16" }
[[udp.fields]]
at = 0
kind = "f32"
signal = "pump_pressure"
age = 0.5
"#;

fn datagram(pressure: f32, number: u16) -> Vec<u8> {
    [pressure.to_le_bytes().as_slice(), &number.to_le_bytes()].concat()
}

#[test]
fn repeated_old_and_impossible_datagrams_are_not_measured() {
    let Some(network) = Network::new("odd") else { return };
    let (_keep, folder) = folder();
    let (description, bag) = (folder.join("bridge.toml"), folder.join("bag"));
    std::fs::write(&description, DESCRIPTION.replace("ADDRESS", "")).unwrap();
    let parameter = format!("description:={}", description.display());
    let bridge = network.start(&["node", "arm-bridge", "--ros-args", "-p", &parameter]);
    let recorder = network.start(&["record", "/arm/state", "/diagnostics", "-o", bag.to_str().unwrap()]);
    is_heard(&bag);
    inside(&network, || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        let send = |pressure, number| socket.send_to(&datagram(pressure, number), "127.0.0.1:5600").unwrap();
        for round in 0..100_u16 {
            let number = 65_500_u16.wrapping_add(round);
            if round == 50 {
                continue; // one is lost
            }
            send(1e6, number);
            send(9e6, number); // sent again with another content
            send(8e6, number.wrapping_sub(7)); // recorded before
            sleep(0.01);
        }
        // All states of the last second are of this one.
        for round in 100..150_u16 {
            send(1e30, 65_500_u16.wrapping_add(round));
            sleep(0.01);
        }
    });
    tells(&bag, "repeated or old datagrams", "198");
    // Silence: what is not sent again becomes old.
    until("an unmeasured pressure", || {
        messages_so_far::<ArmState>(&bag, "/arm/state").last().is_some_and(|(_, state)| state.pump_pressure.is_nan())
    });
    assert_eq!(recorder.interrupt().0, 0);
    assert_eq!(bridge.interrupt().0, 0);
    let pressures: Vec<f64> =
        messages::<ArmState>(&bag, "/arm/state").into_iter().map(|(_, state)| state.pump_pressure).collect();
    let measured: Vec<f64> = pressures.iter().copied().filter(|value| value.is_finite()).collect();
    assert!(measured.len() > 50, "{}", measured.len());
    assert!(measured.iter().all(|value| (value - 1e6).abs() < 1.0), "{measured:?}");
    assert!(pressures.last().unwrap().is_nan());
    assert_eq!(value(&bag, "missing datagrams"), "1");
    let words: Vec<String> = messages::<DiagnosticArray>(&bag, "/diagnostics")
        .into_iter()
        .flat_map(|(_, array)| array.status)
        .flat_map(|status| status.values.into_iter().map(|entry| format!("{}={}", entry.key, entry.value)))
        .collect();
    assert!(words.iter().any(|word| word.starts_with("pump_pressure=out of range")), "{words:?}");
    Fault {
        group: "Pages and bridges",
        tried: "datagrams of the bridge sent again, old ones, and one of 1e30 Pa in a field without limits",
        outcome: "dropped and counted by their number; the impossible value is not measured and told",
    }
    .survived(&[
        ("repeated or old", value(&bag, "repeated or old datagrams")),
        ("missing", value(&bag, "missing datagrams")),
        ("states with another value", "0".to_string()),
    ]);
}

#[test]
fn datagrams_of_other_machines_are_taken_only_from_those_named() {
    let Some((machine, other)) = Network::pair("senders") else { return };
    let (_keep, folder) = folder();
    let mut taken = Vec::new();
    let named = [
        ("", "0"),
        ("address = \"0.0.0.0\"\nsenders = [\"10.99.0.7\"]", "100"),
        ("address = \"0.0.0.0\"\nsenders = [\"10.99.0.2\"]", "0"),
    ];
    for (number, (line, refused)) in named.into_iter().enumerate() {
        let (description, bag) = (folder.join(format!("{number}.toml")), folder.join(format!("bag{number}")));
        std::fs::write(&description, DESCRIPTION.replace("ADDRESS", line)).unwrap();
        let parameter = format!("description:={}", description.display());
        let bridge = machine.start(&["node", "arm-bridge", "--ros-args", "-p", &parameter]);
        let recorder = machine.start(&["record", "/arm/state", "/diagnostics", "-o", bag.to_str().unwrap()]);
        is_heard(&bag);
        inside(&other, || {
            let socket = UdpSocket::bind("10.99.0.2:0").unwrap();
            for number in 0..100 {
                let _ = socket.send_to(&datagram(1e6, number), "10.99.0.1:5600");
                sleep(0.01);
            }
        });
        // What was sent last has been judged: two diagnostics later all of it is told.
        records(&bag, "/diagnostics", 4);
        tells(&bag, "datagrams of other senders", refused);
        assert_eq!(recorder.interrupt().0, 0);
        assert_eq!(bridge.interrupt().0, 0);
        let states = messages::<ArmState>(&bag, "/arm/state");
        taken.push(states.iter().filter(|(_, state)| state.pump_pressure.is_finite()).count());
    }
    assert_eq!(taken[..2], [0, 0]);
    assert!(taken[2] > 25, "{taken:?}");
    // An open door without a list is refused.
    let description = folder.join("open.toml");
    std::fs::write(&description, DESCRIPTION.replace("ADDRESS", "address = \"0.0.0.0\"")).unwrap();
    let parameter = format!("description:={}", description.display());
    let bridge = machine.start(&["node", "arm-bridge", "--ros-args", "-p", &parameter]);
    let (status, log) = bridge.wait();
    assert!(status == 1 && log.contains("senders = ["), "{log}");
    Fault {
        group: "Pages and bridges",
        tried: "another machine sends datagrams to the bridge's port",
        outcome: "the port is not open to it; with an address only named senders are heard, and without names it does not start",
    }
    .survived(&[("states measured closed, unnamed, named", format!("{}, {}, {}", taken[0], taken[1], taken[2]))]);
}
