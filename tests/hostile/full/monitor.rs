//! The energy monitor: no alarm without a reason, no memory for strangers.

use std::net::TcpStream;
use std::path::Path;
use std::time::Instant;

use excavator_msgs::common::{DiagnosticArray, DiagnosticStatus, KeyValue};
use excavator_msgs::{ArmState, CylinderState, Header, OrificeCommand};
use excavator_ros::{Outlet, TopicQos};

use crate::hostile::fault::Fault;
use crate::hostile::full::faces::{answer, page};
use crate::hostile::inside::{command_of_now, inside, node_of_the_test, peak_memory};
use crate::live::{Network, folder, messages_so_far, records, sleep, until};

fn state(cylinders: Vec<CylinderState>, nanoseconds: i64) -> ArmState {
    let stamp = excavator_msgs::Time::from_nanoseconds(nanoseconds).unwrap();
    ArmState {
        header: Header { stamp, frame_id: String::new() },
        cylinders,
        pump_pressure: 0.0,
        tank_pressure: 0.0,
        pump_flow: 0.0,
        oil_temperature: 0.0,
    }
}

/// What the monitor told of passivity, with its level.
type Polls = Vec<(u8, DiagnosticStatus)>;

/// The polls in a bag so far, without those of a simulator that was not let run in time: it stamps its states with a time that is
/// not that of its machine.
fn polls(bag: &Path) -> Polls {
    let all: Vec<(f64, DiagnosticStatus)> = messages_so_far::<DiagnosticArray>(bag, "/diagnostics")
        .into_iter()
        .flat_map(|(time, array)| array.status.into_iter().map(move |status| (time, status)))
        .collect();
    let mut late: Vec<f64> = Vec::new();
    let mut starts = String::from("0");
    for (time, status) in &all {
        let now = status.values.iter().find(|entry| entry.key == "schedule restarts");
        if let Some(now) = now.filter(|now| now.value != starts) {
            starts.clone_from(&now.value);
            late.push(*time);
        }
    }
    let in_time = |time: f64| late.iter().all(|late| !(late - 2.0..late + 3.0).contains(&time));
    let polls = all.into_iter().filter(|(_, status)| status.name.ends_with("passivity"));
    polls.filter(|(time, _)| in_time(*time)).map(|(_, status)| (status.level, status)).collect()
}

/// The monitor's polls while the arm moves and rests, in rounds of `seconds`, until there are enough of them.
fn judged(
    network: &Network,
    folder: &Path,
    name: &str,
    model: &Path,
    seconds: f64,
    enough: impl Fn(&Polls) -> bool + Send + 'static,
) -> Polls {
    let bag = folder.join(name);
    let (model, window) = (format!("model:={}", model.display()), "watch_window:=0.5");
    // Slower than usual, so that it is in time beside other work.
    let simulator = network.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"]);
    let monitor = network.start(&["node", "energy-monitor", "--ros-args", "-p", &model, "-p", window]);
    let recorder = network.start(&["record", "/diagnostics", "-o", bag.to_str().unwrap()]);
    records(&bag, "/diagnostics", 3);
    let written = bag.clone();
    inside(network, move || {
        let node = node_of_the_test("operator");
        let commands = node.link.publish("/arm/orifice_command", TopicQos::reliable(10)).unwrap();
        until("enough polls", || {
            swing(&commands, seconds);
            enough(&polls(&written))
        });
        node.leave();
    });
    for (part, program) in [("recorder", recorder), ("monitor", monitor), ("simulator", simulator)] {
        println!("{name}: the {part} ends");
        assert_eq!(program.interrupt().0, 0);
    }
    polls(&bag)
}

/// A third of the time at rest, a third to and fro, a third at rest again.
fn swing(commands: &Outlet<OrificeCommand>, seconds: f64) {
    let start = Instant::now();
    while start.elapsed().as_secs_f64() < seconds {
        let time = start.elapsed().as_secs_f64();
        let moves = (seconds / 3.0..2.0 * seconds / 3.0).contains(&time);
        let area = if moves { 5e-5 * (std::f64::consts::TAU * 0.4 * time).sin() } else { 0.0 };
        let _ = commands.publish(command_of_now(area));
        sleep(0.02);
    }
}

/// Polls without an alarm, at least `wanted`; alarms, and polls, with a wrong model.
fn alarms(network: &Network, folder: &Path, seconds: f64, wanted: usize) -> (usize, usize, usize) {
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../config/zx30u-arm.toml");
    let right = judged(network, folder, "right", &config, seconds, move |polls| polls.len() >= wanted);
    let amber: Vec<_> = right.iter().filter(|(level, _)| *level > 0).collect();
    assert!(amber.is_empty(), "{} of {}: {amber:#?}", amber.len(), right.len());
    // The monitor's model has half the damping of the machine.
    let wrong = folder.join("wrong.toml");
    let text = std::fs::read_to_string(&config).unwrap();
    assert_eq!(text.matches("value = 13000.0").count(), 1);
    std::fs::write(&wrong, text.replace("value = 13000.0", "value = 6500.0")).unwrap();
    let is_told = |polls: &Polls| polls.iter().any(|(level, _)| *level > 0);
    let wrong = judged(network, folder, "wrong", &wrong, 9.0, is_told);
    let told = wrong.iter().filter(|(level, _)| *level > 0).count();
    (right.len(), told, wrong.len())
}

const AMBER: Fault = Fault {
    group: "Pages and bridges",
    tried: "simulator and energy monitor of the same model, nothing wrong, the arm at rest and in motion",
    outcome: "no warning; with half the damping in the monitor's model there is one as soon as the arm moves",
};

#[test]
fn a_right_model_is_no_alarm_and_a_wrong_one_is() {
    let Some(network) = Network::new("amber") else { return };
    let (_keep, folder) = folder();
    let (polls, told, of) = alarms(&network, &folder, 15.0, 6);
    AMBER
        .survived(&[("polls without a warning", polls.to_string()), ("with a wrong model", format!("{told} of {of}"))]);
}

#[test]
#[ignore = "takes three minutes"]
fn a_right_model_is_no_alarm_for_ninety_polls() {
    let Some(network) = Network::new("ninety") else { return };
    let (_keep, folder) = folder();
    let (polls, told, of) = alarms(&network, &folder, 170.0, 90);
    AMBER
        .survived(&[("polls without a warning", polls.to_string()), ("with a wrong model", format!("{told} of {of}"))]);
}

#[test]
fn enormous_states_and_diagnostics_do_not_fill_monitor_and_page() {
    let Some(network) = Network::new("enormous") else { return };
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../config/zx30u-arm.toml");
    let model = format!("model:={}", model.display());
    let monitor = network.start(&["node", "energy-monitor", "--ros-args", "-p", &model]);
    let dashboard = network.start(&["dashboard"]);
    let (frames, sent) = inside(&network, || {
        until("the page", || TcpStream::connect(page()).is_ok());
        let node = node_of_the_test("stranger");
        let states = node.link.publish("/arm/state", TopicQos::reliable(10)).unwrap();
        let parts = node.link.publish("/diagnostics", TopicQos::reliable(10)).unwrap();
        until("monitor and page to listen", || {
            ["/arm/state", "/diagnostics"].into_iter().all(|topic| node.link.has_readers(topic))
        });
        let mut sent = 0;
        let start = Instant::now();
        for round in 0..150_i64 {
            let many = (0..800).map(|number| CylinderState::unmeasured(&format!("c{round}-{number}"))).collect();
            let long = vec![CylinderState::unmeasured(&"x".repeat(100_000))];
            for cylinders in [many, long] {
                sent += usize::from(states.publish(state(cylinders, round * 1_000_000)).is_ok());
            }
            let part = |number: i64| DiagnosticStatus {
                level: 2,
                name: format!("stranger {round}: {number}"),
                message: "m".repeat(1000),
                hardware_id: String::new(),
                values: vec![KeyValue { key: "k".repeat(500), value: "v".repeat(500) }; 20],
            };
            let array = DiagnosticArray { header: Header::default(), status: (0..4).map(part).collect() };
            sent += usize::from(parts.publish(array).is_ok());
            sleep(0.02);
        }
        println!("{sent} messages in {:.1} s", start.elapsed().as_secs_f64());
        let history = answer("localhost", "/history");
        node.leave();
        (history.len(), sent)
    });
    let (of_monitor, of_page) = (peak_memory(&network, "energy-monitor"), peak_memory(&network, "dashboard"));
    assert_eq!(dashboard.interrupt().0, 0);
    assert_eq!(monitor.interrupt().0, 0);
    assert!(sent > 100, "{sent}");
    assert!(of_monitor < 200.0 && of_page < 200.0, "{of_monitor} MB, {of_page} MB");
    assert!(frames < 9_000_000, "{frames}");
    Fault {
        group: "Pages and bridges",
        tried: "states with 800 cylinders or names of 100 kB, diagnostics of 600 parts with long texts",
        outcome: "the monitor refuses such states, the page shows the first of each, cut; neither grows",
    }
    .survived(&[
        ("messages", sent.to_string()),
        ("peak memory of the monitor [MB]", format!("{of_monitor:.0}")),
        ("of the dashboard [MB]", format!("{of_page:.0}")),
    ]);
}
