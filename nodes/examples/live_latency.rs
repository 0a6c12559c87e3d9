//! How regularly the simulator publishes, and how long a state takes to its energy message.
//!
//!     cargo run -p excavator --example live_latency -- target/debug/excavator [SECONDS] [RATE]
//!
//! Starts `arm-simulator` and `energy-monitor` as processes and listens to both. What is printed:
//!
//! - **the machine: plain datagram**: a thread sends one per ms to another over the loopback before any node runs: what
//!   this machine gives to two threads that do nothing else, to hold the other figures against;
//! - **the machine: relayed**: the same through a chain of as many threads as a state and its energy message pass;
//! - **lateness of publication**: publication less stamp, less the smallest of these; the stamps are an even grid;
//! - **interval of publication**: time between two publications of a state;
//! - **state on the wire**: from the publication of a state to its arrival here;
//! - **processing**: from the publication of a state to that of the energy message which it triggers: one hop on the
//!   wire and the monitor's work;
//! - **arrival**: from the publication of a state to the arrival here of the energy message which it triggers: two hops;
//! - **age of the content**: from the publication of the state that an energy message is about, whose stamp it has, to
//!   its arrival. A causal derivative needs half its window of later states, so this is longer by `half_width`.
//!
//! And how many of either were lost, how much processor time the nodes took.
//!
//! Publication is the time that the publisher wrote into the message, by the same clock on one machine.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use std::collections::BTreeMap;
use std::net::UdpSocket;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use excavator_msgs::{ArmState, EnergyState};
use excavator_ros::{RosArguments, Supervisor, TopicQos};

/// Left out at the beginning, in which peers find each other, s.
const SETTLING: f64 = 3.0;
/// Half width of the monitor's window, its default, ns.
const HALF_WIDTH: i64 = 10_000_000;

/// Threads that a state and its energy message pass after the simulator's loop: the middleware's of the simulator; of the
/// monitor the middleware's, the link's, the monitor's own and the middleware's again; the middleware's and the link's here.
const RELAYS: usize = 7;

/// A process that is ended when dropped.
struct Node(Child);

impl Node {
    fn start(program: &str, words: &[&str]) -> Node {
        Node(Command::new(program).args(words).stdin(Stdio::null()).stderr(Stdio::null()).spawn().unwrap())
    }

    /// Processor time used so far, s, with that of the processes that it has started.
    fn processor_time(&self) -> f64 {
        let pid = self.0.id();
        let children = std::fs::read_to_string(format!("/proc/{pid}/task/{pid}/children")).unwrap_or_default();
        let children = children.split_whitespace().map(|child| processor_time_of(child.parse().unwrap()));
        processor_time_of(pid) + children.sum::<f64>()
    }
}

fn processor_time_of(pid: u32) -> f64 {
    let text = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
    // The name in parentheses may hold spaces; user and system time are fields 14 and 15, in hundredths of a second.
    let fields: Vec<&str> = text.rsplit(')').next().unwrap().split_whitespace().collect();
    (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
}

impl Drop for Node {
    fn drop(&mut self) {
        let _ = Command::new("kill").args(["-INT", &self.0.id().to_string()]).status();
        let _ = self.0.wait();
    }
}

/// Stamp, publication and arrival, ns since the epoch.
type Times = (i64, i64, i64);

fn now() -> i64 {
    i64::try_from(SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_nanos()).unwrap()
}

fn print(name: &str, mut values: Vec<f64>) {
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share) as usize];
    let (median, p99, p999, most) = (at(0.5), at(0.99), at(0.999), at(1.0));
    println!("{name:<28}{median:>9.3}{p99:>9.3}{p999:>9.3}{most:>9.3}   ({} samples)", values.len());
}

/// Times of datagrams through a chain of threads, from the first to the last, ms.
///
/// A state passes as many threads on its way to the energy message and back here: the simulator's loop, and in each
/// process the middleware's thread for reading and writing and the one that is called.
fn relayed_datagrams(count: usize, threads: usize) -> Vec<f64> {
    let sockets: Vec<UdpSocket> = (0..threads).map(|_| UdpSocket::bind("127.0.0.1:0").unwrap()).collect();
    let addresses: Vec<_> = sockets.iter().map(|socket| socket.local_addr().unwrap()).collect();
    for socket in &sockets {
        socket.set_read_timeout(Some(Duration::from_secs(1))).unwrap();
    }
    let mut times = Vec::new();
    std::thread::scope(|scope| {
        for (place, socket) in sockets[..threads - 1].iter().enumerate() {
            let next = addresses[place + 1];
            scope.spawn(move || {
                let mut bytes = [0; 8];
                while socket.recv(&mut bytes).is_ok() {
                    socket.send_to(&bytes, next).unwrap();
                }
            });
        }
        let first = addresses[0];
        scope.spawn(move || {
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            for _ in 0..count {
                std::thread::sleep(Duration::from_millis(1));
                socket.send_to(&now().to_le_bytes(), first).unwrap();
            }
        });
        let mut bytes = [0; 8];
        while times.len() < count && sockets[threads - 1].recv(&mut bytes).is_ok() {
            times.push((now() - i64::from_le_bytes(bytes)) as f64 * 1e-6);
        }
    });
    times
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let Some(program) = words.get(1) else { panic!("usage: live_latency EXCAVATOR [SECONDS] [RATE]") };
    let seconds: f64 = words.get(2).map_or(10.0, |word| word.parse().unwrap());
    let rate = words.get(3).map_or("1000", |word| word.as_str());
    let datagrams = relayed_datagrams(3000, 1);
    let relayed = relayed_datagrams(3000, RELAYS);
    let supervisor = Supervisor::start("latency_meter", &RosArguments::default(), Vec::new()).unwrap();
    let states: Arc<Mutex<Vec<Times>>> = Arc::default();
    let energies: Arc<Mutex<Vec<Times>>> = Arc::default();
    let kept = Arc::clone(&states);
    let take = move |state: ArmState, received: excavator_ros::Received| {
        kept.lock().unwrap().push((state.header.stamp.nanoseconds(), received.published.unwrap(), now()));
    };
    supervisor.link.subscribe("/arm/state", TopicQos::reliable(1000), take).unwrap();
    let kept = Arc::clone(&energies);
    let take = move |energy: EnergyState, received: excavator_ros::Received| {
        kept.lock().unwrap().push((energy.header.stamp.nanoseconds(), received.published.unwrap(), now()));
    };
    supervisor.link.subscribe("/arm/energy", TopicQos::reliable(1000), take).unwrap();
    let monitor = Node::start(program, &["node", "energy-monitor", "--ros-args", "-p", "model:=zx30u-arm"]);
    let simulator = Node::start(program, &["node", "arm-simulator", "--ros-args", "-p", &format!("rate:={rate}")]);
    std::thread::sleep(Duration::from_secs_f64(SETTLING));
    states.lock().unwrap().clear();
    energies.lock().unwrap().clear();
    let before = (simulator.processor_time(), monitor.processor_time());
    std::thread::sleep(Duration::from_secs_f64(seconds));
    let used = (simulator.processor_time() - before.0, monitor.processor_time() - before.1);
    let (states, energies) = (states.lock().unwrap().clone(), energies.lock().unwrap().clone());
    drop((simulator, monitor));
    supervisor.leave();

    let milliseconds = |from: i64, to: i64| (to - from) as f64 * 1e-6;
    let lateness: Vec<f64> = states.iter().map(|(stamp, published, _)| milliseconds(*stamp, *published)).collect();
    let least = lateness.iter().copied().fold(f64::INFINITY, f64::min);
    println!("{:<28}{:>9}{:>9}{:>9}{:>9}   ms", "", "p50", "p99", "p99.9", "max");
    print("the machine: plain datagram", datagrams);
    print("the machine: relayed", relayed);
    print("lateness of publication", lateness.iter().map(|late| late - least).collect());
    print("interval of publication", states.windows(2).map(|pair| milliseconds(pair[0].1, pair[1].1)).collect());
    print(
        "state on the wire",
        states.iter().map(|(_, published, arrived)| milliseconds(*published, *arrived)).collect(),
    );
    let by_stamp: BTreeMap<i64, i64> = states.iter().map(|(stamp, published, _)| (*stamp, *published)).collect();
    let (mut processing, mut arrival, mut age) = (Vec::new(), Vec::new(), Vec::new());
    for (stamp, published, arrived) in &energies {
        // The state that fills the window; a nanosecond is lost where stamps become seconds.
        let trigger = by_stamp.range(stamp + HALF_WIDTH - 2..).next();
        if let (Some((_, trigger)), Some(own)) = (trigger, by_stamp.get(stamp)) {
            processing.push(milliseconds(*trigger, *published));
            arrival.push(milliseconds(*trigger, *arrived));
            age.push(milliseconds(*own, *arrived));
        }
    }
    print("processing", processing);
    print("arrival", arrival);
    print("age of the content", age);
    // Stamps are an even grid: what is not there was lost.
    let period = 1e9 / rate.parse::<f64>().unwrap();
    let grid = |stamps: &mut dyn Iterator<Item = i64>| {
        let (mut first, mut last, mut count) = (i64::MAX, i64::MIN, 0i64);
        for stamp in stamps {
            (first, last, count) = (first.min(stamp), last.max(stamp), count + 1);
        }
        (((last - first) as f64 / period).round() as i64 + 1 - count, count)
    };
    for (name, (lost, count)) in [
        ("states", grid(&mut states.iter().map(|entry| entry.0))),
        ("energies", grid(&mut energies.iter().map(|entry| entry.0))),
    ] {
        println!("{name}: {lost} lost, {count} arrived");
    }
    println!("simulator {:.1} %, monitor {:.1} % of one core", 100.0 * used.0 / seconds, 100.0 * used.1 / seconds);
}
