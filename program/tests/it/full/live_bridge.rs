//! Datagrams of another maker become states; what does not come any more is not measured, and told.

use std::path::Path;
use std::process::Command;

use crate::live::{Network, folder, messages, messages_so_far, records, until};
use excavator_msgs::ArmState;
use excavator_msgs::common::DiagnosticArray;

const DESCRIPTION: &str = r#"
rate = 100.0
[[udp]]
port = 5600
length = 4
[[udp.fields]]
at = 0
kind = "f32"
signal = "arm.displacement"
scale = 0.001
offset = -0.3
minimum = -0.31
maximum = 0.31
age = 0.2
"#;

#[test]
fn datagrams_become_states_and_silence_becomes_nan() {
    let Some(network) = Network::new("bridge") else { return };
    let (_keep, folder) = folder();
    let (description, bag) = (folder.join("bridge.toml"), folder.join("bag"));
    std::fs::write(&description, DESCRIPTION).unwrap();
    let parameter = format!("description:={}", description.display());
    let bridge = network.start(&["node", "arm-bridge", "--ros-args", "-p", &parameter]);
    let recorder = network.start(&["record", "/arm/state", "/diagnostics", "-o", bag.to_str().unwrap()]);
    records(&bag, "/arm/state", 1);
    records(&bag, "/diagnostics", 1);
    // 400.0 as a little-endian f32, fifty times per second for two seconds; one datagram in ten is too short.
    let script = r"for i in $(seq 100); do printf '\x00\x00\xc8\x43' > /dev/udp/127.0.0.1/5600;
        [ $((i % 10)) = 0 ] && printf 'abc' > /dev/udp/127.0.0.1/5600; sleep 0.02; done; true";
    assert!(
        Command::new("ip").args(["netns", "exec", network.name(), "bash", "-c", script]).status().unwrap().success()
    );
    until("all to be told", || {
        let told = told(&bag);
        told.iter().any(|word| word.starts_with("arm.displacement=stale"))
            && told.contains(&"refused datagrams=10".into())
    });
    assert_eq!(recorder.interrupt().0, 0);
    assert_eq!(bridge.interrupt().0, 0);
    let states: Vec<(f64, ArmState)> = messages(&bag, "/arm/state");
    let measured: Vec<f64> =
        states.iter().map(|(_, state)| state.cylinders[0].displacement).filter(|value| value.is_finite()).collect();
    assert!(measured.len() > 50, "{} of {}", measured.len(), states.len());
    assert!(measured.iter().all(|value| (value - 0.1).abs() < 1e-6));
    let last = &states[states.len() - 1].1;
    assert!(last.cylinders[0].displacement.is_nan() && last.pump_pressure.is_nan());
}

/// Everything that the diagnostics in a bag told so far, as `key=value`.
fn told(bag: &Path) -> Vec<String> {
    messages_so_far::<DiagnosticArray>(bag, "/diagnostics")
        .into_iter()
        .flat_map(|(_, array)| array.status)
        .flat_map(|status| status.values.into_iter().map(|value| format!("{}={}", value.key, value.value)))
        .collect()
}

#[test]
fn without_a_description_it_says_what_to_do() {
    let Some(network) = Network::new("bare") else { return };
    let (status, log) = network.start(&["node", "arm-bridge"]).wait();
    assert_eq!(status, 1);
    assert!(log.contains("-p description:="), "{log}");
}
