//! The player and the page beside a live machine.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use excavator_msgs::OrificeCommand;
use excavator_ros::TopicQos;

use crate::hostile::fault::Fault;
use crate::hostile::inside::{command_of_now, inside, node_of_the_test, peak_memory};
use crate::live::{LONGEST_WAIT, Network, folder, found, messages, recorded, records, sleep, until};

/// A recording of a simulator that an operator commands.
fn commanded(network: &Network, folder: &Path) -> PathBuf {
    let bag = folder.join("recorded");
    let simulator = network.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=100"]);
    let recorder = network.start(&["record", "--all", "-o", bag.to_str().unwrap()]);
    let seen = bag.clone();
    inside(network, move || {
        let node = node_of_the_test("operator");
        let commands = node.link.publish("/arm/orifice_command", TopicQos::reliable(10)).unwrap();
        until("recorded commands", || {
            for _ in 0..20 {
                let _ = commands.publish(command_of_now(3e-5));
                sleep(0.025);
            }
            recorded(&seen, "/arm/orifice_command") > 60
        });
        node.leave();
    });
    assert_eq!(simulator.interrupt().0, 0);
    assert_eq!(recorder.interrupt().0, 0);
    bag
}

#[test]
fn a_bag_that_is_played_moves_nothing_unless_asked_to() {
    let Some(network) = Network::new("replay") else { return };
    let (_keep, folder) = folder();
    let bag = commanded(&network, &folder);
    let mut played = Vec::new();
    for (name, words) in [("all", vec![]), ("asked", vec!["--topics", "/arm/orifice_command"])] {
        let again = folder.join(name);
        let recorder = network.start(&["record", "--all", "-o", again.to_str().unwrap()]);
        let mut play = vec!["play", bag.to_str().unwrap(), "--rate", "4", "--start-paused"];
        play.extend(words);
        let player = network.start(&play);
        recorder.says(if name == "all" { "recording /joint_states (" } else { "recording /arm/orifice_command (" });
        records(&again, "/diagnostics", 2);
        player.signal("-USR1");
        let (status, log) = player.wait();
        assert_eq!(status, 0, "{log}");
        assert_eq!(recorder.interrupt().0, 0);
        assert_eq!(recorded(&again, "/joint_states") > 0, name == "all");
        let said = log.lines().filter(|line| line.contains("commands are not played") && line.contains("--topics"));
        played.push((messages::<OrificeCommand>(&again, "/arm/orifice_command").len(), said.count()));
    }
    assert_eq!(played[0], (0, 1));
    assert!(played[1].0 > 20 && played[1].1 == 0, "{played:?}");
    Fault {
        group: "Commands",
        tried: "excavator play of a bag with commands beside a live machine",
        outcome: "commands and stops are left out unless named with --topics, and a line says so",
    }
    .survived(&[("commands played unasked, asked", format!("{}, {}", played[0].0, played[1].0))]);
}

const PORT: u16 = 8050;

/// Where the dashboard is.
pub fn page() -> SocketAddr {
    SocketAddr::from(([127, 0, 0, 1], PORT))
}

/// The answer to a request.
pub fn answer(host: &str, path: &str) -> String {
    let mut stream = TcpStream::connect(page()).unwrap();
    stream.set_read_timeout(Some(LONGEST_WAIT)).unwrap();
    // A server that is full may have closed it already.
    let _ = write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n");
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn the_page_answers_to_its_names_and_to_no_others() {
    let Some(network) = Network::new("host") else { return };
    let dashboard = network.start(&["dashboard", "--allow-host", "pit.example"]);
    let refused = inside(&network, || {
        until("the page", || TcpStream::connect(page()).is_ok());
        for host in ["localhost:8050", "127.0.0.1:8050", "[::1]:8050", "pit.example"] {
            let page = answer(host, "/");
            assert!(page.starts_with("HTTP/1.1 200"), "{host}: {page:.300}");
            let head = page.to_lowercase();
            for header in ["x-content-type-options: nosniff", "frame-ancestors 'none'", "cache-control: no-store"] {
                assert!(head.contains(header), "{header}: {page:.600}");
            }
        }
        let foreign = ["evil.example", "evil.example:8050", "localhost.evil.example", "10.0.0.1", ""];
        for host in foreign {
            for path in ["/", "/history", "/stream"] {
                let page = answer(host, path);
                assert!(page.starts_with("HTTP/1.1 421"), "{host}: {page:.300}");
                assert!(!page.contains("uPlot") && !page.contains("data:"), "{host}");
            }
        }
        foreign.len()
    });
    assert_eq!(dashboard.interrupt().0, 0);
    Fault {
        group: "Pages and bridges",
        tried: "requests to the dashboard with a foreign Host header (DNS rebinding)",
        outcome: "421 for the page, its history and its stream; answered are localhost, its address and --allow-host",
    }
    .survived(&[("foreign names refused", refused.to_string())]);
}

#[test]
fn idle_connections_are_bounded_and_let_go() {
    let Some(network) = Network::new("idle") else { return };
    let dashboard = network.start(&["dashboard"]);
    let (held, free) = inside(&network, || {
        until("the page", || TcpStream::connect(page()).is_ok());
        let mut idle = Vec::new();
        let start = Instant::now();
        for number in 0..500 {
            let Ok(mut stream) = TcpStream::connect_timeout(&page(), Duration::from_secs(1)) else { continue };
            // Every second one sends the beginning of a header.
            if number % 2 == 0 {
                let _ = stream.write_all(b"GET / HTTP/1.1\r\nHost: loc");
            }
            stream.set_nonblocking(true).unwrap();
            idle.push(stream);
        }
        let open = |stream: &mut TcpStream| matches!(stream.read(&mut [0; 200]), Err(error) if error.kind() == std::io::ErrorKind::WouldBlock);
        let held = found("the surplus to be let go", || {
            let held = idle.iter_mut().filter_map(|stream| open(stream).then_some(())).count();
            (held <= 64).then_some(held)
        });
        // The places are free again when the time for a header is over, though nobody has closed anything.
        until("the page again", || answer("localhost", "/").starts_with("HTTP/1.1 200"));
        (held, start.elapsed().as_secs_f64())
    });
    let peak = peak_memory(&network, "dashboard");
    assert_eq!(dashboard.interrupt().0, 0);
    assert!(held > 0, "none was held");
    assert!(peak < 200.0, "{peak} MB");
    Fault {
        group: "Pages and bridges",
        tried: "500 idle connections to the dashboard",
        outcome: "64 are held, for the 5 s that a header may take; then the page answers again",
    }
    .survived(&[
        ("connections held", held.to_string()),
        ("page answers after [s]", format!("{free:.1}")),
        ("peak memory [MB]", format!("{peak:.0}")),
    ]);
}
