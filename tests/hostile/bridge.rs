//! Datagrams to the bridge.

use std::net::UdpSocket;
use std::path::Path;
use std::time::Duration;

use excavator_msgs::ArmState;
use excavator_msgs::common::DiagnosticArray;

use crate::hostile::fault::Fault;
use crate::hostile::inside::inside;
use crate::live::{Network, folder, messages, sleep};

/// The last values that a part of a node told.
fn values(bag: &Path, part: &str) -> Vec<(String, String)> {
    let mut statuses = messages::<DiagnosticArray>(bag, "/diagnostics").into_iter().flat_map(|(_, array)| array.status);
    let last = statuses.rfind(|status| status.name.ends_with(part)).expect("the part");
    last.values.into_iter().map(|entry| (entry.key, entry.value)).collect()
}

fn value(values: &[(String, String)], key: &str) -> String {
    values.iter().find(|(name, _)| name == key).unwrap_or_else(|| panic!("{key}: {values:?}")).1.clone()
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

/// Time in which new counts reach the recorder, s: diagnostics come once per second.
const DIAGNOSTICS: f64 = 2.0;

#[test]
fn repeated_old_and_impossible_datagrams_are_not_measured() {
    let Some(network) = Network::new("odd") else { return };
    let (_keep, folder) = folder();
    let (description, bag) = (folder.join("bridge.toml"), folder.join("bag"));
    std::fs::write(&description, DESCRIPTION.replace("ADDRESS", "")).unwrap();
    let parameter = format!("description:={}", description.display());
    let bridge = network.start(&["node", "arm-bridge", "--ros-args", "-p", &parameter]);
    let recorder = network.start(&["record", "/arm/state", "/diagnostics", "-o", bag.to_str().unwrap()]);
    sleep(2.5);
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
    sleep(DIAGNOSTICS);
    assert_eq!(recorder.interrupt().0, 0);
    assert_eq!(bridge.interrupt().0, 0);
    let pressures: Vec<f64> =
        messages::<ArmState>(&bag, "/arm/state").into_iter().map(|(_, state)| state.pump_pressure).collect();
    let measured: Vec<f64> = pressures.iter().copied().filter(|value| value.is_finite()).collect();
    assert!(measured.len() > 50, "{}", measured.len());
    assert!(measured.iter().all(|value| (value - 1e6).abs() < 1.0), "{measured:?}");
    assert!(pressures.last().unwrap().is_nan());
    let told = values(&bag, "signals");
    assert_eq!(value(&told, "repeated or old datagrams"), "198");
    assert_eq!(value(&told, "missing datagrams"), "1");
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
        ("repeated or old", value(&told, "repeated or old datagrams")),
        ("missing", value(&told, "missing datagrams")),
        ("states with another value", "0".to_string()),
    ]);
}

#[test]
fn datagrams_of_other_machines_are_taken_only_from_those_named() {
    let Some((machine, other)) = Network::pair("senders") else { return };
    let (_keep, folder) = folder();
    let mut taken = Vec::new();
    let named =
        ["", "address = \"0.0.0.0\"\nsenders = [\"10.99.0.7\"]", "address = \"0.0.0.0\"\nsenders = [\"10.99.0.2\"]"];
    for (number, line) in named.iter().enumerate() {
        let (description, bag) = (folder.join(format!("{number}.toml")), folder.join(format!("bag{number}")));
        std::fs::write(&description, DESCRIPTION.replace("ADDRESS", line)).unwrap();
        let parameter = format!("description:={}", description.display());
        let bridge = machine.start(&["node", "arm-bridge", "--ros-args", "-p", &parameter]);
        let recorder = machine.start(&["record", "/arm/state", "/diagnostics", "-o", bag.to_str().unwrap()]);
        sleep(2.5);
        inside(&other, || {
            let socket = UdpSocket::bind("10.99.0.2:0").unwrap();
            for number in 0..100 {
                let _ = socket.send_to(&datagram(1e6, number), "10.99.0.1:5600");
                sleep(0.01);
            }
        });
        sleep(DIAGNOSTICS);
        assert_eq!(recorder.interrupt().0, 0);
        assert_eq!(bridge.interrupt().0, 0);
        let states = messages::<ArmState>(&bag, "/arm/state");
        let measured = states.iter().filter(|(_, state)| state.pump_pressure.is_finite()).count();
        taken.push((measured, value(&values(&bag, "signals"), "datagrams of other senders")));
    }
    assert_eq!(taken[0], (0, "0".to_string()));
    assert_eq!(taken[1], (0, "100".to_string()));
    assert!(taken[2].0 > 50 && taken[2].1 == "0", "{taken:?}");
    // An open door without a list is refused.
    let description = folder.join("open.toml");
    std::fs::write(&description, DESCRIPTION.replace("ADDRESS", "address = \"0.0.0.0\"")).unwrap();
    let parameter = format!("description:={}", description.display());
    let bridge = machine.start(&["node", "arm-bridge", "--ros-args", "-p", &parameter]);
    let (status, log) = bridge.wait(Duration::from_secs(15));
    assert!(status == 1 && log.contains("senders = ["), "{log}");
    Fault {
        group: "Pages and bridges",
        tried: "another machine sends datagrams to the bridge's port",
        outcome: "the port is not open to it; with an address only named senders are heard, and without names it does not start",
    }
    .survived(&[("states measured closed, unnamed, named", format!("{}, {}, {}", taken[0].0, taken[1].0, taken[2].0))]);
}
